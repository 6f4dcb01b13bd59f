// SPDX-License-Identifier: GPL-2.0-or-later
// One exception type for everything the core refuses. Messages name the value, the limit and the remedy.
#pragma once

#include <sstream>
#include <stdexcept>
#include <string>

namespace nscd {

struct Error : std::runtime_error {
  using std::runtime_error::runtime_error;
};

template <class... Parts>
[[noreturn]] void fail(const Parts &...parts)
{
  std::ostringstream text;
  text.precision(6);
  (text << ... << parts);
  throw Error(text.str());
}

}    // namespace nscd
