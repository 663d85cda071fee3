// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <core/Body.hpp>

namespace yade {
class InteractionContainer : public Serializable { // 0xc0 bytes
public:
	using ContainerT = vector<shared_ptr<Interaction>>;
	ContainerT                      linIntrs;            // 0x18, only the first currSize entries count
	ContainerT                      sortedIntrs;         // 0x30
	const vector<shared_ptr<Body>>* bodies;              // 0x48
	size_t                          currSize;            // 0x50
	shared_ptr<Interaction>         empty;               // 0x58
	ContainerT                      interaction;         // 0x68
	bool                            dirty;               // 0x80
	std::mutex                      drawloopmutex;       // 0x88
	bool                            serializeSorted;     // 0xb0
	long                            iterColliderLastRun; // 0xb8
	InteractionContainer() = delete;                     // belongs to Scene
	virtual ~InteractionContainer();
	YADE_SDK_STOCK_CLASS
	bool                           insert(Body::id_t, Body::id_t);
	bool                           insert(const shared_ptr<Interaction>&);
	bool                           erase(Body::id_t, Body::id_t, int linPos);
	const shared_ptr<Interaction>& find(Body::id_t, Body::id_t);
	void                           requestErase(Body::id_t, Body::id_t);
	void                           requestErase(const shared_ptr<Interaction>&);
	void                           requestErase(Interaction*);
	void                           clear();
	void                           eraseNonReal();
	ContainerT::iterator           begin() { return linIntrs.begin(); }
	ContainerT::iterator           end() { return linIntrs.begin() + currSize; }
	size_t                         size() const { return currSize; }
	shared_ptr<Interaction>&       operator[](size_t i) { return linIntrs[i]; }
};
} // namespace yade
