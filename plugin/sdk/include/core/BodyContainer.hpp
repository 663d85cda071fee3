// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <core/Body.hpp>

namespace yade {
class BodyContainer : public Serializable { // 0xc8 bytes
public:
	vector<shared_ptr<Body>> body;              // 0x18, null where a body was erased
	bool                     dirty;             // 0x30
	bool                     checkedByCollider; // 0x31
	vector<Body::id_t>       insertedBodies;    // 0x38
	vector<Body::id_t>       erasedBodies;      // 0x50
	vector<Body::id_t>       realBodies;        // 0x68
	bool                     useRedirection;    // 0x80
	bool                     enableRedirection; // 0x81
	vector<Body::id_t>       subdomainBodies;   // 0x88, build with MPI
	std::mutex               drawloopmutex;     // 0xa0
	BodyContainer() = delete;                   // belongs to Scene
	virtual ~BodyContainer();
	YADE_SDK_STOCK_CLASS
	Body::id_t insert(shared_ptr<Body>);
	bool       erase(Body::id_t, bool eraseClumpMembers);
	void       updateRealBodies();
	size_t     size() const { return body.size(); }
	bool       exists(Body::id_t id) const { return id >= 0 && size_t(id) < body.size() && body[id]; }
	auto       begin() { return body.begin(); }
	auto       end() { return body.end(); }

	shared_ptr<Body>&       operator[](unsigned int id) { return body[id]; }
	const shared_ptr<Body>& operator[](unsigned int id) const { return body[id]; }
};
} // namespace yade
