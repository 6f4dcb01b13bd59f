// SPDX-License-Identifier: GPL-2.0-or-later
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include "check.hpp"

#include <cmath>
#include <cstdio>

namespace check {

std::string far(const char *what, double value, double expected, double tolerance)
{
  if (std::abs(value - expected) <= tolerance) return "";
  char text[300];
  std::snprintf(text, sizeof text, "%s is %.17g, expected %.17g within %g", what, value, expected, tolerance);
  return text;
}

std::string lacking(const std::string &message, const std::string &part)
{
  if (message.find(part) != std::string::npos) return "";
  std::string text = "'";
  return text.append(message).append("' lacks '").append(part).append("'");
}

}    // namespace check
