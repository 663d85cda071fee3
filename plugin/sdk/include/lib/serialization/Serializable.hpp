// SPDX-License-Identifier: GPL-2.0-or-later
// Root of all classes that are saved and seen from Python, and the macros that declare them.
#pragma once
#include <lib/base/Logging.hpp>
#include <lib/factory/ClassFactory.hpp>

namespace yade {
class Serializable : public Factorable { // 0x18 bytes
public:
	Serializable() = default;
	virtual ~Serializable();
	string           getBaseClassName(unsigned int = 0) const override;
	int              getBaseClassNumber() const override;
	string           getClassName() const override;
	virtual void     pySetAttr(const std::string& key, const py::object& value);          // 5
	virtual py::dict pyDict() const;                                                      // 6
	virtual py::dict pyDictCustom() const;                                                // 7
	virtual void     callPostLoad();                                                      // 8
	virtual void     checkPyClassRegistersItself(const std::string& thisClassName) const; // 9
	virtual void     pyRegisterClass(py::object scope);                                   // 10
	virtual void     pyHandleCustomCtorArgs(py::tuple& args, py::dict& kw);               // 11
	void             pyUpdateAttrs(const py::dict&);
};
} // namespace yade

// what every stock class overrides; the bodies are in the library
#define YADE_SDK_STOCK_CLASS                                                                                                                                   \
	string   getBaseClassName(unsigned int = 0) const override;                                                                                            \
	int      getBaseClassNumber() const override;                                                                                                          \
	string   getClassName() const override;                                                                                                                \
	void     pySetAttr(const std::string& key, const py::object& value) override;                                                                          \
	py::dict pyDict() const override;                                                                                                                      \
	void     callPostLoad() override;                                                                                                                      \
	void     pyRegisterClass(py::object scope) override;

#include <sdk/archive.hpp>
#include <sdk/declare.hpp>

YADE_SDK_STOCK_ARCHIVE(Serializable)
