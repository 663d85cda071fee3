// SPDX-License-Identifier: GPL-2.0-or-later
// YADE's logging macros: warnings and errors to stderr in YADE's form, the rest compiled away.
#pragma once
#include <iostream>
#define DECLARE_LOGGER static_assert(true, "")
#define CREATE_LOGGER(cls) static_assert(true, "")
#define YADE_SDK_LOG(level, text) (std::cerr << "<" level "> " << __func__ << ": " << text << std::endl)
#define LOG_FATAL(text) YADE_SDK_LOG("FATAL ERROR", text)
#define LOG_ERROR(text) YADE_SDK_LOG("ERROR", text)
#define LOG_WARN(text) YADE_SDK_LOG("WARNING", text)
#define LOG_INFO(text) static_cast<void>(0)
#define LOG_DEBUG(text) static_cast<void>(0)
#define LOG_TRACE(text) static_cast<void>(0)
