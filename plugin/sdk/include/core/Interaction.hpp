// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <core/IGeom.hpp>
#include <core/IPhys.hpp>

namespace yade {
class Scene;
class IGeomFunctor;
class IPhysFunctor;
class LawFunctor;
class Interaction : public Serializable { // 0xa8 bytes
public:
	using id_t = int;
	bool isActive; // 0x18
	struct FunctorCache {
		bool                     geomExists; // 0x20
		shared_ptr<IGeomFunctor> geom;       // 0x28
		shared_ptr<IPhysFunctor> phys;       // 0x38
		shared_ptr<LawFunctor>   constLaw;   // 0x48
	} functorCache;
	id_t              id1, id2;     // 0x58, 0x5c; a geometry functor may have swapped them
	long              iterMadeReal; // 0x60
	long              iterLastSeen; // 0x68
	shared_ptr<IGeom> geom;         // 0x70
	shared_ptr<IPhys> phys;         // 0x80
	Vector3i          cellDist;     // 0x90
	int               linIx;        // 0x9c
	long              iterBorn;     // 0xa0
	Interaction();
	Interaction(id_t, id_t);
	virtual ~Interaction();
	YADE_SDK_STOCK_CLASS
	py::dict pyDictCustom() const override;
	bool     isReal() const { return geom && phys; }
	bool     isFresh(Scene*);
	id_t     getId1() const { return id1; }
	id_t     getId2() const { return id2; }
	void     reset();
	void     swapOrder();
};
} // namespace yade
YADE_SDK_STOCK_ARCHIVE(Interaction)
