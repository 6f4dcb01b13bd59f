// SPDX-License-Identifier: GPL-2.0-or-later
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include "check.hpp"

#include <cmath>
#include <cstdio>

namespace check {

void failed(const char *file, int line, const char *what) { DOCTEST_ADD_FAIL_CHECK_AT(file, line, what); }

void near(const char *file, int line, const char *what, double value, double expected, double tolerance)
{
  if (std::abs(value - expected) <= tolerance) return;
  char text[300];
  std::snprintf(text, sizeof text, "%s is %.17g, expected %.17g within %g", what, value, expected, tolerance);
  failed(file, line, text);
}

void says(const char *file, int line, const std::string &message, const std::string &part)
{
  if (message.find(part) != std::string::npos) return;
  const std::string text = "'" + message + "' lacks '" + part + "'";
  failed(file, line, text.c_str());
}

}    // namespace check
