// SPDX-License-Identifier: GPL-2.0-or-later
// The four kinds of functors of the interaction loop. They run in an OpenMP region: never throw from go().
#pragma once
#include <core/Body.hpp>
#include <core/Functor.hpp>

namespace yade {
class BoundFunctor : public Functor1D<Shape, void, boost::mpl::vector<const shared_ptr<Shape>&, shared_ptr<Bound>&, const Se3r&, const Body*>> {
public:
	BoundFunctor() = default;
	virtual ~BoundFunctor();
	YADE_SDK_STOCK_CLASS
};
// returns whether the bodies touch
class IGeomFunctor : public Functor2D<
                             Shape,
                             Shape,
                             bool,
                             boost::mpl::vector<
                                     const shared_ptr<Shape>&,
                                     const shared_ptr<Shape>&,
                                     const State&,
                                     const State&,
                                     const Vector3r&,
                                     const bool&,
                                     const shared_ptr<Interaction>&>> {
public:
	IGeomFunctor() = default;
	virtual ~IGeomFunctor();
	virtual void preStep(); // slot 15
	YADE_SDK_STOCK_CLASS
};
class IPhysFunctor : public Functor2D<
                             Material,
                             Material,
                             void,
                             boost::mpl::vector<const shared_ptr<Material>&, const shared_ptr<Material>&, const shared_ptr<Interaction>&>> {
public:
	IPhysFunctor() = default;
	virtual ~IPhysFunctor();
	YADE_SDK_STOCK_CLASS
};
// returns false when the interaction shall be erased
class LawFunctor : public Functor2D<IGeom, IPhys, bool, boost::mpl::vector<shared_ptr<IGeom>&, shared_ptr<IPhys>&, Interaction*>> {
public:
	LawFunctor() = default;
	virtual ~LawFunctor();
	YADE_SDK_STOCK_CLASS
};
} // namespace yade
YADE_SDK_STOCK_ARCHIVE(BoundFunctor)
YADE_SDK_STOCK_ARCHIVE(IGeomFunctor)
YADE_SDK_STOCK_ARCHIVE(IPhysFunctor)
YADE_SDK_STOCK_ARCHIVE(LawFunctor)
