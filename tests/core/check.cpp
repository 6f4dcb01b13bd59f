// SPDX-License-Identifier: GPL-2.0-or-later
#include "check.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <string_view>
#include <vector>

namespace check {

struct Test {
  std::string_view name;
  void (*run)();
};

static std::vector<Test> &tests()
{
  static std::vector<Test> list;
  return list;
}

static int failures = 0;

Registered::Registered(const char *name, void (*run)()) { tests().push_back({name, run}); }

void failed(const char *file, int line, const char *what)
{
  ++failures;
  std::printf("%s:%d: %s\n", file, line, what);
}

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

static bool passes(const Test &test)
{
  const int before = failures;
  try {
    test.run();
  } catch (const std::exception &error) {
    failed("unexpected exception", 0, error.what());
  }
  std::printf("%s %s\n", failures == before ? "passed" : "FAILED", test.name.data());
  return failures == before;
}

static int run(const std::vector<std::string_view> &names)
{
  std::size_t ran = 0, passed = 0;
  for (const Test &test : tests()) {
    if (!names.empty() && std::find(names.begin(), names.end(), test.name) == names.end()) continue;
    ++ran;
    passed += passes(test);
  }
  std::printf("%zu passed, %zu failed\n", passed, ran - passed);
  const bool found_all = ran == (names.empty() ? tests().size() : names.size());
  if (!found_all) std::printf("no such test: see --list\n");
  return passed == ran && found_all ? 0 : 1;
}

}    // namespace check

int main(int count, char **words)
{
  const std::vector<std::string_view> names(words + 1, words + count);
  if (names.size() == 1 && names[0] == "--list") {
    for (const auto &test : check::tests()) std::printf("%s\n", test.name.data());
    return 0;
  }
  return check::run(names);
}
