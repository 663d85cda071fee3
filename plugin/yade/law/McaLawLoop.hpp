// SPDX-License-Identifier: GPL-2.0-or-later
// What McaLaw asks of the loop over automata and pairs, which is compiled for the plane and for space.
#pragma once
#include "../McaLaw.hpp"

namespace yade {

class McaLawLoop {
public:
	/// Energies of the automata [J/m, in space J].
	struct Energies {
		Real volumetric = 0, deviatoric = 0, kinetic = 0;
		Real centre = 0; ///< what the kinetic energy lacks at the time of the stresses: velocities stand half a step after them
	};
	virtual ~McaLawLoop() = default;
	virtual int      dimension() const = 0;
	virtual void     step(Scene*)      = 0;
	virtual void     addForces(Scene*) = 0;
	virtual Energies energies(Scene&) const = 0;
	/// Largest stable step at rest [s]; J: volume ratio.
	virtual Real stepAtRest(const mca::Material&, Real diameter, Real J) const = 0;
};
namespace plane {
	shared_ptr<McaLawLoop> makeLoop(McaLaw&);
}
namespace space {
	shared_ptr<McaLawLoop> makeLoop(McaLaw&);
}
} // namespace yade
