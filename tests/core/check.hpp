// SPDX-License-Identifier: GPL-2.0-or-later
// What the tests ask with, on doctest: names without quotes, conditions of any form, errors of the core.
#pragma once

#define DOCTEST_CONFIG_NO_SHORT_MACRO_NAMES
#include <doctest/doctest.h>

#include "base/error.hpp"

#include <string>

namespace check {

// What is wrong, or "".
std::string far(const char *what, double value, double expected, double tolerance);
std::string lacking(const std::string &message, const std::string &part);

}    // namespace check

#define TEST(name) DOCTEST_TEST_CASE(#name)
// An assertion, not a message: reports for other programs have no messages. Asked for only where it fails, since there
// are millions.
#define CHECK_IS_EMPTY(text) \
  do { \
    const std::string wrong = text; \
    if (!wrong.empty()) DOCTEST_CHECK_MESSAGE(wrong.empty(), wrong); \
  } while (false)
// doctest's own takes no && and ||.
#define CHECK(condition) \
  do { \
    if (!(condition)) CHECK_IS_EMPTY(#condition); \
  } while (false)
#define CHECK_NEAR(value, expected, tolerance) CHECK_IS_EMPTY(check::far(#value, value, expected, tolerance))
// The text has this part.
#define CHECK_SAYS(text, part) CHECK_IS_EMPTY(check::lacking(text, part))
// The statement must raise nscd::Error with this part in its message.
#define CHECK_ERROR(statement, part) \
  do { \
    try { \
      statement; \
      CHECK_IS_EMPTY("no error from " #statement); \
    } catch (const nscd::Error &error) { \
      CHECK_SAYS(error.what(), part); \
    } \
  } while (false)
