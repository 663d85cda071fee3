// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <core/Body.hpp>
#include <core/Functor.hpp>

namespace yade {
class GLViewInfo;
class GlShapeFunctor
        : public Functor1D<Shape, void, boost::mpl::vector<const shared_ptr<Shape>&, const shared_ptr<State>&, bool, const GLViewInfo&>> {
public:
	GlShapeFunctor() = default;
	virtual ~GlShapeFunctor();
	YADE_SDK_STOCK_CLASS
	virtual string renders() const; // slot 14
	virtual void   initgl();        // 15
};
} // namespace yade
YADE_SDK_STOCK_ARCHIVE(GlShapeFunctor)

#define RENDERS(cls)                                                                                                                                           \
public:                                                                                                                                                        \
	std::string renders() const override { return #cls; }                                                                                                  \
	FUNCTOR1D(cls)
