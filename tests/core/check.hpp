// SPDX-License-Identifier: GPL-2.0-or-later
// All of the test framework: TEST registers a function, the CHECKs count what is wrong, check.cpp has main.
#pragma once

#include "base/error.hpp"

#include <string>

namespace check {

struct Registered {
  Registered(const char *name, void (*run)());
};
void failed(const char *file, int line, const char *what);
void near(const char *file, int line, const char *what, double value, double expected, double tolerance);
void says(const char *file, int line, const std::string &message, const std::string &part);

}    // namespace check

#define TEST(name) \
  static void name(); \
  static const check::Registered registered_##name(#name, name); \
  static void name()
#define CHECK(condition) ((condition) ? void() : check::failed(__FILE__, __LINE__, #condition))
#define CHECK_NEAR(value, expected, tolerance) check::near(__FILE__, __LINE__, #value, value, expected, tolerance)
// The statement must raise nscd::Error with this part in its message.
#define CHECK_ERROR(statement, part) \
  do { \
    try { \
      statement; \
      check::failed(__FILE__, __LINE__, "no error from " #statement); \
    } catch (const nscd::Error &error) { \
      check::says(__FILE__, __LINE__, error.what(), part); \
    } \
  } while (false)
