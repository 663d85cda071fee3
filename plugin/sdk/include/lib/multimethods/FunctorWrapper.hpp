// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <boost/mpl/at.hpp>
#include <boost/mpl/vector.hpp>
#include <string>

namespace yade {
// The members have no bodies here: the table of virtual functions made by the plugin binds to those exported by the library.
// Arguments beyond the list are boost::mpl::void_.
template <class ReturnType, class Arguments> class FunctorWrapper {
	template <int N> using Arg = typename boost::mpl::at<Arguments, boost::mpl::int_<N>>::type;

public:
	FunctorWrapper() = default;
	virtual ~FunctorWrapper() { }           // slots 0, 1
	virtual std::string checkOrder() const; // 2
	virtual ReturnType  go(Arg<0>);         // 3
	virtual ReturnType  go(Arg<0>, Arg<1>);
	virtual ReturnType  go(Arg<0>, Arg<1>, Arg<2>);
	virtual ReturnType  go(Arg<0>, Arg<1>, Arg<2>, Arg<3>);
	virtual ReturnType  go(Arg<0>, Arg<1>, Arg<2>, Arg<3>, Arg<4>);
	virtual ReturnType  go(Arg<0>, Arg<1>, Arg<2>, Arg<3>, Arg<4>, Arg<5>);
	virtual ReturnType  go(Arg<0>, Arg<1>, Arg<2>, Arg<3>, Arg<4>, Arg<5>, Arg<6>);
	virtual ReturnType  goReverse(Arg<0>); // 10
	virtual ReturnType  goReverse(Arg<0>, Arg<1>);
	virtual ReturnType  goReverse(Arg<0>, Arg<1>, Arg<2>);
	virtual ReturnType  goReverse(Arg<0>, Arg<1>, Arg<2>, Arg<3>);
	virtual ReturnType  goReverse(Arg<0>, Arg<1>, Arg<2>, Arg<3>, Arg<4>);
	virtual ReturnType  goReverse(Arg<0>, Arg<1>, Arg<2>, Arg<3>, Arg<4>, Arg<5>);
	virtual ReturnType  goReverse(Arg<0>, Arg<1>, Arg<2>, Arg<3>, Arg<4>, Arg<5>, Arg<6>);
};
} // namespace yade

// inside a functor whose two arguments may come in either order: goReverse is called when they do
#define DEFINE_FUNCTOR_ORDER_2D(type1, type2)                                                                                                                  \
public:                                                                                                                                                        \
	std::string checkOrder() const override { return #type1 " " #type2; }
