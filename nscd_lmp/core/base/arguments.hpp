// SPDX-License-Identifier: GPL-2.0-or-later
// The words of a script's line, handed out one by one; knows for which keyword a value is missing or malformed.
#pragma once

#include "base/error.hpp"

#include <charconv>
#include <string>
#include <type_traits>
#include <vector>

namespace nscd {

class Arguments {
 public:
  explicit Arguments(const std::vector<std::string> &words) : words_(words) {}
  bool done() const { return next_ == words_.size(); }
  bool next_is(std::string_view word) const { return !done() && words_[next_] == word; }
  // Takes the next word if it is this one.
  bool skip(std::string_view word)
  {
    const bool there = next_is(word);
    if (there) keyword_ = of_ + " " + words_[next_++];
    return there;
  }
  // The next word begins a keyword.
  const std::string &keyword() { return keyword_ = of_ = words_[next_++]; }

  const std::string &word()
  {
    if (done()) fail("keyword ", keyword_, " needs a value");
    return words_[next_++];
  }

  // So many words are left at least; `usage` shows what they are of.
  void require(std::size_t count, std::string_view usage) const
  {
    if (words_.size() - next_ < count) fail("too few words: give `", usage, "`");
  }

  template <class Number>
  Number number(const char *wanted = std::is_integral_v<Number> ? "a whole number" : "a number")
  {
    const std::string &text = word();
    Number value{};
    if (!read(text, value)) fail("keyword ", keyword_, ": '", text, "' is not ", wanted);
    return value;
  }

  bool yes_or_no()
  {
    const std::string &text = word();
    if (text == "yes" || text == "on" || text == "true") return true;
    if (text == "no" || text == "off" || text == "false") return false;
    fail("keyword ", keyword_, ": '", text, "' is neither yes nor no");
  }

  // Whether the whole text is a number, as LAMMPS takes it: with a plus, which from_chars does not.
  template <class Number>
  static bool read(std::string_view text, Number &value)
  {
    const char *first = text.data(), *const last = first + text.size();
    const bool plus = text.size() > 1 && text[0] == '+' && text[1] != '-';
    const auto [end, problem] = std::from_chars(first + plus, last, value);
    return problem == std::errc() && end == last;
  }

 private:
  const std::vector<std::string> &words_;
  std::size_t next_ = 0;
  std::string of_, keyword_;   // the keyword, and the word of it that values stand behind
};

}    // namespace nscd
