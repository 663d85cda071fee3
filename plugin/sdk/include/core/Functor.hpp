// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <core/Timing.hpp>
#include <lib/multimethods/FunctorWrapper.hpp>
#include <lib/serialization/Serializable.hpp>

namespace yade {
class Scene;
class Functor : public Serializable { // 0x50 bytes
public:
	shared_ptr<TimingDeltas> timingDeltas;    // 0x18
	Scene*                   scene = nullptr; // 0x28
	string                   label;           // 0x30
	Functor()                      = default;
	virtual ~Functor();
	YADE_SDK_STOCK_CLASS
	virtual vector<string> getFunctorTypes() const; // slot 12
};
template <class DispatchType, class ReturnType, class Arguments> class Functor1D : public Functor, public FunctorWrapper<ReturnType, Arguments> {
public:
	virtual string get1DFunctorType1() const; // 13
	vector<string> getFunctorTypes() const override;
};
template <class DispatchType1, class DispatchType2, class ReturnType, class Arguments>
class Functor2D : public Functor, public FunctorWrapper<ReturnType, Arguments> {
public:
	virtual string get2DFunctorType1() const; // 13
	virtual string get2DFunctorType2() const; // 14
	vector<string> getFunctorTypes() const override;
};
} // namespace yade
YADE_SDK_STOCK_ARCHIVE(Functor)

// inside a functor: the classes it serves
#define FUNCTOR1D(type1)                                                                                                                                       \
public:                                                                                                                                                        \
	std::string get1DFunctorType1() const override { return #type1; }
#define FUNCTOR2D(type1, type2)                                                                                                                                \
public:                                                                                                                                                        \
	std::string get2DFunctorType1() const override { return #type1; }                                                                                      \
	std::string get2DFunctorType2() const override { return #type2; }
