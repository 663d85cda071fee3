// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <core/Body.hpp>

namespace yade {
// forces [N] and torques [N m] of bodies, one array per thread, summed by sync()
class ForceContainer { // 0x130 bytes, no virtual functions
	vector<vector<Vector3r>> _forceData;     // 0x0
	vector<vector<Vector3r>> _torqueData;    // 0x18
	vector<Body::id_t>       _maxId;         // 0x30
	vector<size_t>           sizeOfThreads;  // 0x48
	vector<Vector3r>         _force;         // 0x60
	vector<Vector3r>         _torque;        // 0x78
	vector<Vector3r>         _permForce;     // 0x90
	vector<Vector3r>         _permTorque;    // 0xa8
	size_t                   _size;          // 0xc0
	bool                     syncedSizes;    // 0xc8
	int                      nThreads;       // 0xcc
	bool                     permForceUsed;  // 0xd0
	bool                     permForceSynced; // 0xd1
	std::mutex               globalMutex;    // 0xd8
	Vector3r                 _zero;          // 0x100
public:
	bool          synced;    // 0x118
	unsigned long syncCount; // 0x120
	long          lastReset; // 0x128
	ForceContainer() = delete; // belongs to Scene
	const Vector3r& getForce(Body::id_t);
	const Vector3r& getTorque(Body::id_t);
	void            addForce(Body::id_t, const Vector3r&);
	void            addTorque(Body::id_t, const Vector3r&);
	void            setPermForce(Body::id_t, const Vector3r&);
	void            addMaxId(Body::id_t);
	void            sync();
	const Vector3r  getForceSingle(Body::id_t);
	int             getNumAllocatedThreads() const;
};
} // namespace yade
