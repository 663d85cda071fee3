// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <core/BodyContainer.hpp>
#include <core/Cell.hpp>
#include <core/Engine.hpp>
#include <core/EnergyTracker.hpp>
#include <core/ForceContainer.hpp>
#include <core/InteractionContainer.hpp>

namespace yade {
class OpenGLRenderer;
class DisplayParameters;
class Scene : public Serializable { // 0x2f0 bytes
public:
	unsigned int                          hostNameMax;                  // 0x18
	ForceContainer                        forces;                       // 0x20
	Eigen::Matrix<Real, 10, 1>            SpeedElements;                // 0x150
	shared_ptr<OpenGLRenderer>            renderer;                     // 0x1a0, build with OpenGL
	long                                  prevTime;                     // 0x1b0
	Real                                  dt;                           // 0x1b8, s
	long                                  iter;                         // 0x1c0
	bool                                  subStepping;                  // 0x1c8
	int                                   subStep;                      // 0x1cc
	Real                                  time;                         // 0x1d0, s
	Real                                  speed;                        // 0x1d8, steps/s
	long                                  stopAtIter;                   // 0x1e0
	Real                                  stopAtTime;                   // 0x1e8, s
	bool                                  isPeriodic;                   // 0x1f0
	bool                                  trackEnergy;                  // 0x1f1
	bool                                  doSort;                       // 0x1f2
	bool                                  runInternalConsistencyChecks; // 0x1f3
	Body::id_t                            selectedBody;                 // 0x1f4
	int                                   subdomain;                    // 0x1f8, build with MPI
	shared_ptr<Shape>                     subD;                         // 0x200, build with MPI
	vector<string>                        tags;                         // 0x210
	vector<shared_ptr<Engine>>            engines;                      // 0x228
	vector<shared_ptr<Engine>>            _nextEngines;                 // 0x240
	shared_ptr<BodyContainer>             bodies;                       // 0x258
	shared_ptr<InteractionContainer>      interactions;                 // 0x268
	shared_ptr<EnergyTracker>             energy;                       // 0x278
	vector<shared_ptr<Material>>          materials;                    // 0x288
	shared_ptr<Bound>                     bound;                        // 0x2a0
	shared_ptr<Cell>                      cell;                         // 0x2b0
	vector<shared_ptr<Serializable>>      miscParams;                   // 0x2c0
	vector<shared_ptr<DisplayParameters>> dispParams;                   // 0x2d8
	Scene() = delete; // made by Omega
	virtual ~Scene();
	YADE_SDK_STOCK_CLASS
	shared_ptr<Engine> engineByName(const string& className);
	void               checkStateTypes();
};
} // namespace yade
