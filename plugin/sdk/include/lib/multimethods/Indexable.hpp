// SPDX-License-Identifier: GPL-2.0-or-later
// Class indices for dispatch. The table of virtual functions is not exported by the library, hence all bodies are here.
#pragma once
#include <boost/scoped_ptr.hpp>
#include <stdexcept>

namespace yade {
class Indexable {
protected:
	void createIndex()
	{
		int& index = modifyClassIndex();
		if (index != -1) return;
		index = getMaxCurrentlyUsedClassIndexOfKin() + 1;
		incrementMaxCurrentlyUsedClassIndexOfKin();
	}
	virtual void incrementMaxCurrentlyUsedClassIndexOfKin() { throw std::logic_error("class without index"); } // slot 0
	virtual int& modifyClassIndex() { throw std::logic_error("class without index"); }                         // 1
public:
	Indexable() = default;
	virtual ~Indexable() {}                                                                                                       // 2, 3
	virtual const int& getClassIndex() const { throw std::logic_error("class without index"); }                      // 4
	virtual const int& getBaseClassIndex(int) const { throw std::logic_error("class without index"); }               // 5
	virtual const int& getMaxCurrentlyUsedClassIndexOfKin() const { throw std::logic_error("class without index"); } // 6
};
} // namespace yade

// a stock class with an index of its own
#define YADE_SDK_STOCK_INDEX                                                                                                                                   \
protected:                                                                                                                                                     \
	int& modifyClassIndex() override;                                                                                                                      \
                                                                                                                                                               \
public:                                                                                                                                                        \
	const int& getClassIndex() const override;                                                                                                             \
	const int& getBaseClassIndex(int) const override;
// a stock class at the top of its kin (State, Shape, ...), which also counts the indices
#define YADE_SDK_STOCK_INDEX_ROOT                                                                                                                              \
	YADE_SDK_STOCK_INDEX                                                                                                                                   \
	const int& getMaxCurrentlyUsedClassIndexOfKin() const override;                                                                                        \
                                                                                                                                                               \
protected:                                                                                                                                                     \
	void incrementMaxCurrentlyUsedClassIndexOfKin() override;                                                                                              \
                                                                                                                                                               \
public:

// inside a new class that has a place in dispatch; its constructor calls createIndex()
#define REGISTER_CLASS_INDEX(cls, base)                                                                                                                        \
	static int& modifyClassIndexStatic()                                                                                                                   \
	{                                                                                                                                                      \
		static int index = -1;                                                                                                                         \
		return index;                                                                                                                                  \
	}                                                                                                                                                      \
                                                                                                                                                               \
protected:                                                                                                                                                     \
	int& modifyClassIndex() override { return modifyClassIndexStatic(); }                                                                                  \
                                                                                                                                                               \
public:                                                                                                                                                        \
	const int& getClassIndex() const override { return modifyClassIndexStatic(); }                                                                         \
	const int& getBaseClassIndex(int depth) const override                                                                                                 \
	{                                                                                                                                                      \
		static boost::scoped_ptr<base> instance(new base);                                                                                             \
		const ::yade::Indexable*       parent = instance.get();                                                                                        \
		return depth == 1 ? parent->getClassIndex() : parent->getBaseClassIndex(depth - 1);                                                            \
	}
