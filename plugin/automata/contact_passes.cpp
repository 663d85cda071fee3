// SPDX-License-Identifier: GPL-2.0-or-later
#include "../threads.hpp"
#include "contact_pairs.hpp"
#include <algorithm>
#include <array>
#include <atomic>
#include <climits>

namespace mca::automata {
namespace {
	constexpr long parallelFrom = 2048; ///< half-contacts below which waking a thread costs more than it brings
	/// The arrays as bare pointers: through the vectors their starts would be read again for each contact, and nothing would vectorise.
	struct View {
#define MCA_NUMBER(name, type, presence, text) type* name;
#define MCA_VECTOR(name, presence, text, ...) Planes<double> name;
		MCA_CONTACT_FIELDS(MCA_NUMBER, MCA_VECTOR)
#undef MCA_VECTOR
#undef MCA_NUMBER
#define MCA_NUMBER(name, type, presence, text) name = C.name.data();
#define MCA_VECTOR(name, presence, text, ...) name = C.name.planes();
		explicit View(Contacts& C) { MCA_CONTACT_FIELDS(MCA_NUMBER, MCA_VECTOR) }
#undef MCA_VECTOR
#undef MCA_NUMBER
	};
	/// Sums of K quantities over each row, in the order of the row. All in one go: rows are short, and their ends cost more than the sums.
	template <size_t K> void addRows(const Contacts& C, const std::array<const double*, K>& from, const std::array<double*, K>& to)
	{
		inParts(long(C.rows()), long(C.size()) >= parallelFrom ? 0 : LONG_MAX, [&](long first, long last) {
			for (long r = first; r < last; r++) {
				double sum[K] = {};
				for (int32_t c = C.rowBegin[r]; c < C.rowBegin[r + 1]; c++)
					for (size_t k = 0; k < K; k++)
						sum[k] += from[k][c];
				for (size_t k = 0; k < K; k++)
					to[k][C.rowOwner[r]] = sum[k];
			}
		});
	}
	/// f(rule of contacts as a compile-time constant)
	template <class F> void withRule(VolumeRule rule, F&& f)
	{
		dispatch(rule, [&](auto r) { f(std::integral_constant<VolumeRule, ofContacts(r.value)> {}); });
	}

	/// f(first, last) for parts of all half-contacts. Each loop makes a view of its own: one that is shared keeps it from being vectorised.
	template <class F> void contactParts(const Contacts& C, F&& f) { inParts(long(C.size()), parallelFrom, f); }

	// One half-contact each, in functions of their own: a vector or pair declared in the body of a loop keeps it from being vectorised.

	template <VolumeRule rule> MCA_INLINE void volumeTermOf(const View& V, const Planes<const double>& x, const double* factor, long c)
	{
		const int32_t     i = V.owner[c], j = V.other[c];
		const Vec<double> r    = x.at(j) - x.at(i);
		const double      rest = V.rest[c], d = V.d[c], r2 = dot(r, r), on = pushes(r2, rest, d);
		V.between.set(c, r), V.r2[c] = r2;
		V.pushing[c] = on;
		V.first[c]       = on > 0. ? volumeTerm<rule>(rest, r2) : 0.;
		V.rest[c]    = restAfter(rest, r2, meetsAt(d, factor[i]));
		V.second[c]       = on > 0. ? r2 / (rest * rest) : 1.;
	}
	template <VolumeRule rule> void volumeTerms(const Store& S, Contacts& C)
	{
		contactParts(C, [&](long first, long last) {
			const View V(C);
			const auto x = S.position.planes();
			const double* factor = S.factor.data();
#pragma omp simd
			for (long c = first; c < last; c++)
				volumeTermOf<rule>(V, x, factor, c);
		});
	}

	/// What the trial stresses read of the automata.
	struct Movers {
		const Planes<const double> velocity;
		const Rotations            omega;
		const double *             dTheta, *J;
		explicit Movers(const Store& S) : velocity(S.velocity.planes()), omega(S.omega), dTheta(S.dTheta.data()), J(S.J.data()) { }
	};
	/// Returns the relative speed squared [m2/s2].
	template <bool account> MCA_INLINE double trialOf(const View& V, const Movers& M, double dt, long c)
	{
		const int32_t     i = V.owner[c], j = V.other[c];
		const Vec<double> r = V.between.at(c), v = M.velocity.at(j) - M.velocity.at(i);
		const double      touch = max(V.pushing[c], V.pushing[V.reverse[c]]), perOldJ = perOldRatio(M.dTheta[i], M.J[i]);
		const Side<double> old = scaled(sideOf(V, c), perOldJ);
		const ContactTrial all = contactTrial(
			old, r, v * dt, pairSpin(M.omega.at(i), M.omega.at(j), V.arm[c], dt), pairDilation(M.dTheta[i], M.dTheta[j], ofBoth), V.twoG[c]);
		const Side<double> now = where(touch > 0., all.trial);
		V.touch[c] = touch, V.along[c] = dot(r, v);
		setBefore(V, c, before(all, old, touch > 0.)); // for the account
		setSide(V, c, now);
		V.first[c] = square(now);
		if (account) V.press[c] = product(all.before, now); // place for the sums; the pressure comes later
		return dot(v, v);
	}
	template <bool account> double trial(const Store& S, Contacts& C, double dt)
	{
		std::atomic<double> fastest { 0 };
		contactParts(C, [&](long first, long last) {
			const View   V(C);
			const Movers M(S);
			double       speed2 = 0;
#pragma omp simd reduction(max : speed2)
			for (long c = first; c < last; c++)
				speed2 = max(speed2, trialOf<account>(V, M, dt, c));
			for (double now = fastest; now < speed2 && !fastest.compare_exchange_weak(now, speed2);) { }
		});
		return fastest;
	}

	template <bool account> MCA_INLINE void frictionOf(const View& V, const double* J, const double* dTheta, const double* scale, long c)
	{
		const int32_t      i = V.owner[c];
		const ContactSide  side  = contactSide(V, c, J[i], scale[i]);
		const Side<double> after = afterFriction(side);
		setSide(V, c, after);
		if (account) {
			const ContactWork w = contactWork(side, after, V.perTwoG[c], V.perOwnG[c], dTheta[i], dTheta[V.other[c]]);
			V.first[c] = w.friction, V.second[c] = w.coupling, V.third[c] = w.plastic;
		}
	}
	template <bool account> void friction(const Store& S, Contacts& C, const double* scale)
	{
		contactParts(C, [&](long first, long last) {
			const View    V(C);
			const double *J = S.J.data(), *dTheta = S.dTheta.data(), *by = scale;
#pragma omp simd
			for (long c = first; c < last; c++)
				frictionOf<account>(V, J, dTheta, by, c);
		});
	}

	template <VolumeRule rule> void pressure(const double* h, Contacts& C)
	{
		contactParts(C, [&](long first, long last) {
			const View    V(C);
			const double* share = h;
#pragma omp simd
			for (long c = first; c < last; c++) {
				const int32_t r   = V.reverse[c];
				const double  inv = 1. / V.r2[c], mine = share[V.owner[c]] * pressureShape<rule>(V.rest[c], inv),
					     theirs = share[V.other[c]] * pressureShape<rule>(V.rest[r], inv);
				V.press[c] = (V.pushing[c] > 0. ? mine : 0.) + (V.pushing[r] > 0. ? theirs : 0.);
			}
		});
	}

	/// Planes of n numbers one behind the other.
	MCA_INLINE Planes<double> planesFrom(double* first, long n)
	{
		Planes<double> p;
		for (int c = 0; c < dim; c++)
			p.plane[c] = first + c * n;
		return p;
	}
	/// t: torque, and for the account the shares of pressure and viscosity, n numbers each.
	template <bool account> MCA_INLINE void forceOf(const View& V, double* t, long n, long c)
	{
		const int32_t      r   = V.reverse[c];
		const Vec<double>  x   = V.between.at(c);
		const double       d = V.d[c], inv = 1. / V.r2[c], on = V.touch[c], area = pairArea(1., d);
		const Side<double> both = scaled(ofBothSides(area, sideOf(V, c), sideOf(V, r)), on);
		const double       q  = on * viscousCoefficient(V.along[c], inv, V.viscLinear[c], V.viscQuadratic[c], Lattice::width(d)), pr = on * V.press[c];
		const Vec<double>  F  = contactForce(x, both, inv, q, pr);
		const Turn<double> T  = contactTorque(V.arm[c], x, both, F);
		V.between.set(c, F);
		for (int k = 0; k < turns; k++) t[k * n + c] = turnComponent(T, k);
		if (account) planesFrom(t + turns * n, n).set(c, x * -pr), planesFrom(t + (turns + dim) * n, n).set(c, x * q);
	}
	template <bool account> void forces(Contacts& C, double* t)
	{
		contactParts(C, [&](long first, long last) {
			const View V(C);
			const long n  = long(C.size());
			double*    to = t;
#pragma omp simd
			for (long c = first; c < last; c++)
				forceOf<account>(V, to, n, c);
		});
	}
}

void contactReciprocals(const Store& S, Contacts& C)
{
	C.perTwoG.resize(C.size()), C.perOwnG.resize(C.size());
	for (size_t c = 0; c < C.size(); c++) {
		const double G = S.materials[S.species[S.speciesOf(C.owner[c])].material].G;
		C.perTwoG[c] = reciprocal(C.twoG[c]), C.perOwnG[c] = reciprocal(G);
	}
}

namespace {
	void findShared(const Store& S, const Contacts& C, ContactScratch& out)
	{
		out.shared.clear();
		for (size_t c = 0; hasMirrors(S) && c < C.size(); c++)
			if (const double w = pairShare(S, size_t(C.owner[c]), size_t(C.other[c])); w < 1.) out.shared.push_back({ int32_t(c), w });
	}
	/// These quantities of contacts within planes of symmetry times their share.
	void share(const ContactScratch& in, std::initializer_list<double*> arrays)
	{
		for (const auto& s : in.shared)
			for (double* v : arrays) v[s.contact] *= s.share;
	}
}

double contactVolumes(const Store& S, Contacts& C, VolumeRule rule, ContactScratch& out, size_t& closest)
{
	withRule(rule, [&](auto r) { volumeTerms<r.value>(S, C); });
	findShared(S, C, out);
	share(out, { C.first.data() });
	addRows<1>(C, { C.first.data() }, { out.sum.data() });
	for (size_t r = 0; hasMirrors(S) && r < C.rows(); r++) { // who lies on a plane has the images of its contacts, too
		const size_t i = size_t(C.rowOwner[r]);
		out.sum[i] /= mirrorShare(S, i);
	}
	const long    n       = long(C.size());
	const double* b       = C.second.data();
	double        nearest = 1e300;
#pragma omp simd reduction(min : nearest)
	for (long c = 0; c < n; c++)
		nearest = min(nearest, b[c]);
	closest = nearest < deepestContact ? size_t(std::find(C.second.begin(), C.second.end(), nearest) - C.second.begin()) : 0;
	return nearest;
}

double contactTrial(const Store& S, Contacts& C, double dt, ContactScratch& out, bool account)
{
	const double speed2 = account ? trial<true>(S, C, dt) : trial<false>(S, C, dt);
	share(out, { C.first.data(), C.press.data() });
	if (!account) addRows<1>(C, { C.first.data() }, { out.square.data() });
	else addRows<2>(C, { C.first.data(), C.press.data() }, { out.square.data(), out.old.data() });
	return speed2;
}

void contactFriction(const Store& S, Contacts& C, const ContactScratch& in, ContactWork* work)
{
	work ? friction<true>(S, C, in.scale.data()) : friction<false>(S, C, in.scale.data());
	share(in, { C.first.data(), C.second.data(), C.third.data() });
	for (size_t c = 0; work && c < C.size(); c++)
		work->friction += C.first[c], work->coupling += C.second[c], work->plastic += C.third[c];
}

// (6) of both sides, each with its own rest distance.
void contactPressure(const Store& S, Contacts& C, VolumeRule rule)
{
	withRule(rule, [&](auto r) { pressure<r.value>(S.h.data(), C); });
}

void contactForces(Contacts& C, ContactScratch& out, bool account)
{
	const long n = long(C.size());
	out.terms.resize(account ? n * (turns + 2 * dim) : n * turns);
	double* t = out.terms.data();
	account ? forces<true>(C, t) : forces<false>(C, t);
	for (int c = 0; c < dim; c++) share(out, { C.between[c].data() });
	for (int c = 0; c < (account ? turns + 2 * dim : turns); c++) share(out, { t + c * n });
	std::array<const double*, turns + dim> from;
	std::array<double*, turns + dim>       to;
	for (int c = 0; c < turns; c++)
		from[c] = t + c * n, to[c] = turnPlane(out.torque, c).data();
	for (int c = 0; c < dim; c++)
		from[turns + c] = C.between[c].data(), to[turns + c] = out.force[c].data();
	addRows<turns + dim>(C, from, to);
	if (!account) return;
	std::array<const double*, 2 * dim> shares;
	std::array<double*, 2 * dim>       sums;
	for (int c = 0; c < dim; c++) {
		shares[c] = t + (turns + c) * n, sums[c] = out.volumetric[c].data();
		shares[dim + c] = t + (turns + dim + c) * n, sums[dim + c] = out.viscous[c].data();
	}
	addRows<2 * dim>(C, shares, sums);
}
}
