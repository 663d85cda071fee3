// SPDX-License-Identifier: GPL-2.0-or-later
// Energies shown as O.energy [J]. Typical use: if (scene->trackEnergy) scene->energy->set(value, "mcaKinetic", energyIndex);
#pragma once
#include <lib/serialization/Serializable.hpp>
#include <omp.h>

namespace yade {
template <class T> class OpenMPArrayAccumulator { // 0x40 bytes
public:
	int        CLS;      // bytes in a cache line
	size_t     nThreads;
	int        perCL;    // values in a cache line
	vector<T*> chunks;   // one array per thread
	size_t     sz;
	size_t     nCL;
};
class EnergyTracker : public Serializable { // 0xb0 bytes
public:
	OpenMPArrayAccumulator<Real> energies;  // 0x18
	std::map<string, int>        names;     // 0x58
	vector<bool>                 resetStep; // 0x88
	EnergyTracker();
	virtual ~EnergyTracker();
	YADE_SDK_STOCK_CLASS
	// the library's own findId is not exported from 2026.1.0 on; setItem_py makes the entry
	void findId(const std::string& name, int& id, bool reset, bool newIfNotFound = true)
	{
		auto found = names.find(name);
		if (found == names.end()) {
			if (!newIfNotFound) return;
			setItem_py(name, 0.);
			found = names.find(name);
			resetStep[size_t(found->second)] = reset;
		}
		id = found->second;
	}
	Real getItem_py(const std::string& name);
	void setItem_py(const std::string& name, Real value);
	Real total() const;
	void clear();
	// add to the entry; reset: the entry counts this step only. id: index kept by the caller, -1 at first
	void add(const Real& value, const std::string& name, int& id, bool reset = false)
	{
		if (id < 0) findId(name, id, reset, true);
		energies.chunks[omp_get_thread_num()][id] += value;
	}
	// make the entry equal to value; not inside a parallel region
	void set(const Real& value, const std::string& name, int& id)
	{
		if (id < 0) findId(name, id, false, true);
		for (Real* chunk : energies.chunks)
			chunk[id] = 0;
		energies.chunks[0][id] = value;
	}
};
} // namespace yade
YADE_SDK_STOCK_ARCHIVE(EnergyTracker)
