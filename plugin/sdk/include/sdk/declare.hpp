// SPDX-License-Identifier: GPL-2.0-or-later
// The macros that declare a class, with YADE's spelling and meaning. An attribute is a tuple (Type, name, default, flags, "doc"); see plugin/sdk/README.md.
#pragma once
#include <boost/preprocessor.hpp>
#include <sdk/attributes.hpp>
#include <sdk/bounded.hpp>
#include <sdk/checksum.hpp>
#include <sdk/registry.hpp>

namespace yade {
// Called around saving and loading; a class puts its own member `void postLoad(ThisClass&)` in front of these.
template <class T> void preLoad(T&) { }
template <class T> void postLoad(T&) { }
template <class T> void preSave(T&) { }
template <class T> void postSave(T&) { }
} // namespace yade

#define YADE_SDK_TYPE(a) BOOST_PP_TUPLE_ELEM(5, 0, a)
#define YADE_SDK_NAME(a) BOOST_PP_TUPLE_ELEM(5, 1, a)
#define YADE_SDK_DEFAULT(a) BOOST_PP_TUPLE_ELEM(5, 2, a)
#define YADE_SDK_FLAGS(a) ::yade::sdk::flags(BOOST_PP_TUPLE_ELEM(5, 3, a))
#define YADE_SDK_DOC(a) BOOST_PP_TUPLE_ELEM(5, 4, a)
#define YADE_SDK_KEY(a) BOOST_PP_STRINGIZE(YADE_SDK_NAME(a))

#define YADE_SDK_EACH_MEMBER(r, cls, a) YADE_SDK_TYPE(a) YADE_SDK_NAME(a) = YADE_SDK_TYPE(a)(YADE_SDK_DEFAULT(a));
#define YADE_SDK_EACH_SET(r, cls, a) \
	if (key_ == YADE_SDK_KEY(a)) { \
		YADE_SDK_NAME(a) = ::boost::python::extract<YADE_SDK_TYPE(a)>(value_); \
		return; \
	}
#define YADE_SDK_EACH_DICT(r, cls, a)                                                                                                                          \
	if constexpr (!(YADE_SDK_FLAGS(a) & ::yade::Attr::hidden)) dict_[YADE_SDK_KEY(a)] = ::boost::python::object(YADE_SDK_NAME(a));
#define YADE_SDK_EACH_SAVE(r, cls, a)                                                                                                                          \
	if constexpr (!(YADE_SDK_FLAGS(a) & ::yade::Attr::noSave)) ::yade::sdk::transfer(archive_, YADE_SDK_KEY(a), YADE_SDK_NAME(a));
#define YADE_SDK_EACH_SEAL(r, seal_, a)                                                                                                                        \
	if constexpr (!(YADE_SDK_FLAGS(a) & ::yade::Attr::noSave)) seal_.add(YADE_SDK_NAME(a));
#define YADE_SDK_EACH_PYTHON(r, cls, a)                                                                                                                        \
	::yade::sdk::attribute<cls, YADE_SDK_TYPE(a), &cls::YADE_SDK_NAME(a), YADE_SDK_FLAGS(a)>(                                                              \
	        pyClass_, YADE_SDK_KEY(a), YADE_SDK_DOC(a), BOOST_PP_STRINGIZE(YADE_SDK_TYPE(a)), BOOST_PP_STRINGIZE(YADE_SDK_DEFAULT(a)));

// inside the class
#define YADE_CLASS_BASE_DOC(cls, base, doc) YADE_CLASS_BASE_DOC_ATTRS_CTOR_PY(cls, base, doc, , , )
#define YADE_CLASS_BASE_DOC_ATTRS(cls, base, doc, attrs) YADE_CLASS_BASE_DOC_ATTRS_CTOR_PY(cls, base, doc, attrs, , )
#define YADE_CLASS_BASE_DOC_ATTRS_CTOR(cls, base, doc, attrs, ctor) YADE_CLASS_BASE_DOC_ATTRS_CTOR_PY(cls, base, doc, attrs, ctor, )
#define YADE_CLASS_BASE_DOC_ATTRS_CTOR_PY(cls, base, doc, attrs, ctor, py) \
public: \
	BOOST_PP_SEQ_FOR_EACH(YADE_SDK_EACH_MEMBER, cls, attrs) \
	cls() { ctor; } \
	std::string getClassName() const override { return #cls; } \
	std::string getBaseClassName(unsigned i = 0) const override { return i == 0 ? #base : ""; } \
	int         getBaseClassNumber() const override { return 1; } \
	void        callPostLoad() override \
	{ \
		base::callPostLoad(); \
		postLoad(*this); \
	} \
	void pySetAttr(const std::string& key_, const ::boost::python::object& value_) override \
	{ \
		BOOST_PP_SEQ_FOR_EACH(YADE_SDK_EACH_SET, cls, attrs) \
		base::pySetAttr(key_, value_); \
	} \
	::boost::python::dict pyDict() const override \
	{ \
		::boost::python::dict dict_; \
		BOOST_PP_SEQ_FOR_EACH(YADE_SDK_EACH_DICT, cls, attrs) \
		dict_.update(this->pyDictCustom()); \
		dict_.update(base::pyDict()); \
		return dict_; \
	} \
	void pyRegisterClass(::boost::python::object scopeObject_) override \
	{ \
		checkPyClassRegistersItself(#cls); \
		const ::boost::python::scope                                                                               scope_(scopeObject_); \
		const ::boost::python::docstring_options                                                                   options_(true, true, false); \
		::boost::python::class_<cls, ::boost::shared_ptr<cls>, ::boost::python::bases<base>, ::boost::noncopyable> pyClass_(#cls, doc); \
		pyClass_.def("__init__", ::yade::sdk::keywordConstructor<cls>()); \
		BOOST_PP_SEQ_FOR_EACH(YADE_SDK_EACH_PYTHON, cls, attrs) \
		static_cast<void>(pyClass_ py); \
	} \
	template <class Archive> void serialize(Archive& archive_, unsigned) \
	{ \
		archive_& ::boost::serialization::make_nvp(#base, ::boost::serialization::base_object<base>(*this)); \
		if constexpr (Archive::is_loading::value) \
			preLoad(*this); \
		else \
			preSave(*this); \
		BOOST_PP_SEQ_FOR_EACH(YADE_SDK_EACH_SAVE, cls, attrs) \
		::yade::sdk::Seal seal_; \
		BOOST_PP_SEQ_FOR_EACH(YADE_SDK_EACH_SEAL, seal_, attrs) \
		::yade::sdk::checkSeal(archive_, seal_, #cls); \
		if constexpr (Archive::is_loading::value) \
			postLoad(*this); \
		else \
			postSave(*this); \
	}

// after the class, in namespace yade
#define REGISTER_SERIALIZABLE(cls)                                                                                                                             \
	}                                                                                                                                                      \
	BOOST_CLASS_EXPORT_KEY2(yade::cls, "yade::" #cls)                                                                                                      \
	namespace yade {                                                                                                                                       \
	static_assert(true, "")

#define YADE_SDK_EACH_EXPORT(r, data, cls) BOOST_CLASS_EXPORT_IMPLEMENT(yade::cls)
#define YADE_SDK_EACH_REGISTER(r, data, cls) ::yade::sdk::addClass<::yade::cls>(BOOST_PP_STRINGIZE(cls));
// in namespace yade, once per source file: the classes this file brings
#define YADE_PLUGIN(classes)                                                                                                                                   \
	namespace {                                                                                                                                            \
		const bool BOOST_PP_CAT(yadePluginOf_, BOOST_PP_SEQ_HEAD(classes)) = []() {                                                                    \
			BOOST_PP_SEQ_FOR_EACH(YADE_SDK_EACH_REGISTER, ~, classes)                                                                              \
			return true;                                                                                                                           \
		}();                                                                                                                                           \
	}                                                                                                                                                      \
	}                                                                                                                                                      \
	BOOST_PP_SEQ_FOR_EACH(YADE_SDK_EACH_EXPORT, ~, classes)                                                                                                \
	namespace yade {                                                                                                                                       \
	static_assert(true, "")

// inside a class `old` that derives from `cls` and has nothing of its own: the name that cls had before. Scripts and saved files may go on using it: the bytes
// are those of cls.
#define YADE_SDK_OLD_NAME(old, cls, doc)                                                                                                                       \
public:                                                                                                                                                        \
	std::string getClassName() const override { return #old; }                                                                                             \
	std::string getBaseClassName(unsigned i = 0) const override { return i == 0 ? #cls : ""; }                                                             \
	void        pyRegisterClass(::boost::python::object scopeObject_) override                                                                             \
	{                                                                                                                                                      \
		checkPyClassRegistersItself(#old);                                                                                                             \
		const ::boost::python::scope             scope_(scopeObject_);                                                                                 \
		const ::boost::python::docstring_options options_(true, true, false);                                                                         \
		::boost::python::class_<old, ::boost::shared_ptr<old>, ::boost::python::bases<cls>, ::boost::noncopyable> pyClass_(#old, doc);                \
		pyClass_.def("__init__", ::yade::sdk::keywordConstructor<old>());                                                                             \
	}                                                                                                                                                      \
	template <class Archive> void serialize(Archive& archive_, unsigned version_)                                                                         \
	{                                                                                                                                                      \
		::boost::serialization::void_cast_register<old, cls>();                                                                                       \
		cls::serialize(archive_, version_);                                                                                                            \
	}
