// SPDX-License-Identifier: GPL-2.0-or-later
// What the tests ask with, on doctest: names without quotes, conditions of any form, errors of the core.
#pragma once

#define DOCTEST_CONFIG_NO_SHORT_MACRO_NAMES
#include <doctest/doctest.h>

#include "base/error.hpp"

#include <string>

namespace check {

void failed(const char *file, int line, const char *what);
void near(const char *file, int line, const char *what, double value, double expected, double tolerance);
void says(const char *file, int line, const std::string &message, const std::string &part);

}    // namespace check

#define TEST(name) DOCTEST_TEST_CASE(#name)
// Of any form; doctest's own takes no && and ||.
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
