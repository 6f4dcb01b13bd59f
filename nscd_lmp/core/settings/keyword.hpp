// SPDX-License-Identifier: GPL-2.0-or-later
// One keyword of fix nscd: how it is read, checked and told, and what is said of it.
//
// The table (keywords.cpp) is the one place where keywords stand. The reader, the checks of ranges, the description of
// a run, nscd_lmp.attach and the tables of the docs come from it.
#pragma once

#include "settings/settings.hpp"
#include "base/arguments.hpp"

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace nscd {

// Numbers that a keyword takes. Not-a-number is in none.
struct Limits {
  double lo = -std::numeric_limits<double>::infinity(), hi = std::numeric_limits<double>::infinity();
  bool lo_is_in = true;

  bool has(double value) const { return (lo_is_in ? value >= lo : value > lo) && value <= hi; }
  // As a table has it: "0 to 1", ">= 0"; nothing if all numbers are in.
  std::string text() const;
};

// What stands behind a keyword, and where it goes to.
struct Value {
  std::string kind;   // "number", "whole number", "word", "yes or no", or what it is in its own words
  std::function<void(Settings &, Arguments &)> read;
  std::function<std::string(const Settings &)> write{};        // as it would be read; "" where none was given
  std::function<std::optional<double>(const Settings &)> number{};   // to be in the range
  std::function<std::vector<std::string>()> choices{};         // of words
  bool repeats = false;                                        // may be given several times
};

struct Keyword {
  std::string_view name;
  Value value;
  Limits range{};
  // Behind the range in its error message: why, and what to do.
  std::string_view reason{};
  // The default, where that is not one value that Settings{} has.
  std::string_view otherwise{};
  std::string_view doc;
  // Whether describe() has words of its own for it; what else is not the default is told as it is written.
  bool described = false;
};

// In the order of the docs.
const std::vector<Keyword> &keywords();

// Raises Error naming the choices.
const Keyword &find_keyword(std::string_view name);

// The default, as a table has it.
std::string default_of(const Keyword &keyword);

}    // namespace nscd
