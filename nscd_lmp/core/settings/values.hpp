// SPDX-License-Identifier: GPL-2.0-or-later
// Kinds of values for the table of keywords. Each is made with `of`, which says where the value is: of(settings) is a
// reference to it, an optional where none may be given.
#pragma once

#include "settings/keyword.hpp"

#include <sstream>

namespace nscd::values {

template <class T>
struct Held {
  using Type = T;
  static std::optional<T> of(const T &value) { return value; }
};
template <class T>
struct Held<std::optional<T>> {
  using Type = T;
  static std::optional<T> of(const std::optional<T> &value) { return value; }
};
template <class Of>
using held = Held<std::remove_cvref_t<decltype(std::declval<Of>()(std::declval<Settings &>()))>>;

// As short as it can be while it is read back as the same number.
template <class Number>
std::string written(Number value)
{
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  return {text, end};
}

template <class Of>
Value number(Of of)
{
  using Number = typename held<Of>::Type;
  return {.kind = std::is_integral_v<Number> ? "whole number" : "number",
          .read = [of](Settings &s, Arguments &w) { of(s) = w.number<Number>(); },
          .write =
              [of](const Settings &s) {
                const std::optional<Number> value = held<Of>::of(of(s));
                return value ? written(*value) : std::string();
              },
          .number =
              [of](const Settings &s) -> std::optional<double> {
            const std::optional<Number> value = held<Of>::of(of(s));
            if (!value) return {};
            return double(*value);
          }};
}

// A coefficient of friction: a number or `stick`.
inline double read_friction(Arguments &words)
{
  return words.skip("stick") ? stick : words.number<double>("a number, nor stick");
}
inline std::string written_friction(double mu) { return mu == stick ? "stick" : written(mu); }

template <class Of>
Value friction(Of of)
{
  Value value = number(of);
  value.kind = "number or stick";
  value.read = [of](Settings &s, Arguments &w) { of(s) = read_friction(w); };
  value.write = [of](const Settings &s) { return written_friction(of(s)); };
  return value;
}

template <class Of>
Value yes_or_no(Of of)
{
  return {.kind = "yes or no",
          .read = [of](Settings &s, Arguments &w) { of(s) = w.yes_or_no(); },
          .write = [of](const Settings &s) { return std::string(of(s) ? "yes" : "no"); }};
}

[[noreturn]] inline void refuse_choice(std::string_view what, std::string_view word, const std::vector<std::string> &of)
{
  std::string choices;
  for (const std::string &choice : of) choices.append(choices.empty() ? "" : ", ").append(choice);
  fail("unknown ", what, " '", word, "': choose one of ", choices);
}

// One of an enum class, whose enumerators are 0, 1, ... in the order of `names`.
template <class Of>
Value choice(std::string_view what, std::vector<std::string> names, Of of)
{
  using Enum = typename held<Of>::Type;
  return {.kind = "word",
          .read =
              [=](Settings &s, Arguments &w) {
                const std::string &word = w.word();
                for (std::size_t k = 0; k < names.size(); ++k)
                  if (word == names[k]) {
                    of(s) = Enum(k);
                    return;
                  }
                refuse_choice(what, word, names);
              },
          .write =
              [=](const Settings &s) {
                const std::optional<Enum> value = held<Of>::of(of(s));
                return value ? names[std::size_t(*value)] : std::string();
              },
          .choices = [names] { return names; }};
}

// The name of an entry of a registry, which is complete only once the library is loaded; checked when it is looked up.
template <class Entries, class Of>
Value name_of(const Entries &(*entries)(), Of of)
{
  return {.kind = "word",
          .read = [of](Settings &s, Arguments &w) { of(s) = w.word(); },
          .write = [of](const Settings &s) { return of(s); },
          .choices =
              [entries] {
                std::vector<std::string> names;
                for (const auto &entry : entries()) names.emplace_back(entry.name);
                return names;
              }};
}

}    // namespace nscd::values
