// SPDX-License-Identifier: GPL-2.0-or-later
#include "variable_course.hpp"

#include "contact/space.hpp"

#include <input.h>
#include <variable.h>

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;

namespace {

bool is_variable(const std::string &word) { return word.rfind("v_", 0) == 0; }

double number(const std::string &word)
{
  double value = 0;
  if (!nscd::Arguments::read(word, value)) nscd::fail("rotate: '", word, "' is not a number");
  return value;
}

void require_words(const std::vector<std::string> &words, std::size_t first, std::size_t count, const char *usage)
{
  if (first + count > words.size()) nscd::fail("too few words: give `", usage, "`");
}

}    // namespace

void VariableCourse::read(std::vector<std::string> &words)
{
  for (std::size_t k = 0; k < words.size();)
    if (words[k] == "move") take_move(words, k);
    else if (words[k] == "rotate" && k + 1 < words.size() && is_variable(words[k + 1])) take_rotation(words, k);
    else ++k;
}

void VariableCourse::take_move(std::vector<std::string> &words, std::size_t first)
{
  constexpr std::size_t count = 4;
  require_words(words, first, count, "move v_x v_y v_z");
  if (moves_) nscd::fail("move is given twice: give it once");
  moves_ = true;
  for (std::size_t d = 0; d < 3; ++d) {
    const std::string &word = words[first + 1 + d];
    if (word == "NULL") continue;
    if (!is_variable(word)) nscd::fail("move: '", word, "' is neither a variable, v_NAME, nor NULL");
    along_[d] = word.substr(2);
  }
  if (along_[0].empty() && along_[1].empty() && along_[2].empty())
    nscd::fail("move: all three are NULL: give a variable for one of them, or leave move out");
  words.erase(words.begin() + long(first), words.begin() + long(first + count));
}

void VariableCourse::take_rotation(std::vector<std::string> &words, std::size_t first)
{
  constexpr std::size_t count = 8;
  require_words(words, first, count, "rotate v_theta x y z ax ay az");
  if (rotates) nscd::fail("rotate is given twice: give it once");
  rotates = true;
  angle_ = words[first + 1].substr(2);
  for (int d = 0; d < 3; ++d) {
    point[d] = number(words[first + 2 + std::size_t(d)]);
    axis[d] = number(words[first + 5 + std::size_t(d)]);
  }
  const double size = nscd::length(axis);
  if (!(size > 0 && std::isfinite(size))) nscd::fail("rotate: the axis must be a vector other than (0, 0, 0)");
  axis = axis / size;
  words.erase(words.begin() + long(first), words.begin() + long(first + count));
}

double VariableCourse::ask(const std::string &variable) const
{
  if (variable.empty()) return 0;
  Variable *const all = lmp_->input->variable;
  const int number = all->find(variable.c_str());
  if (number < 0) nscd::fail(name_, ": there is no variable ", variable, ": define it ahead of the run");
  if (!all->equalstyle(number))
    nscd::fail(name_, ": variable ", variable, " is not of style equal: a wall moves by one that is");
  const double value = all->compute_equal(number);
  if (!std::isfinite(value))
    nscd::fail(name_, ": variable ", variable, " is ", value, ", which is no place and no angle");
  return value;
}

nscd::Place VariableCourse::ask() const
{
  nscd::Place place;
  for (int d = 0; d < 3; ++d) place.shift[d] = ask(along_[d]);
  place.angle = ask(angle_);
  return place;
}

void VariableCourse::begin_run(double time)
{
  time_ = time;
  start_ = end_ = ask();
}

void VariableCourse::begin_step(double time, double dt)
{
  time_ = time;
  start_ = end_;
  end_ = ask();
  dt_ = dt;
}

nscd::Place VariableCourse::at(double time) const
{
  constexpr double round_off = 1e-9;
  const double share = (time - time_) / dt_;
  if (std::abs(share) < round_off) return start_;
  if (std::abs(share - 1) < round_off) return end_;
  return {start_.shift + (end_.shift - start_.shift) * share, start_.angle + (end_.angle - start_.angle) * share};
}
