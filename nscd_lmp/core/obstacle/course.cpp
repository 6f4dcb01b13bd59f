// SPDX-License-Identifier: GPL-2.0-or-later
#include "obstacle/course.hpp"

#include "contact/space.hpp"

#include <cmath>

namespace nscd {

namespace {

int read_dimension(Arguments &words, const std::string &what)
{
  const std::string word = words.word();
  if (word == "x" || word == "y" || word == "z") return word[0] - 'x';
  fail(what, ": '", word, "' is no direction: give x, y or z");
}

double read_period(Arguments &words, const std::string &what)
{
  const double period = words.number<double>();
  if (period > 0 && std::isfinite(period)) return period;
  fail(what, ": the period ", period, " must be > 0");
}

}    // namespace

bool GivenCourse::read(Arguments &words, const std::string &name)
{
  const auto begins = [&](const char *word, bool is_given) {
    if (!words.next_is(word)) return false;
    if (is_given) fail(name, ": ", word, " is given twice: give it once");
    return words.skip(word);
  };
  if (begins("wiggle", wiggles_)) return read_wiggle(words, name), true;
  if (begins("shear", shears_)) return read_shear(words), true;
  if (begins("rotate", rotates)) return read_rotation(words, name), true;
  return false;
}

void GivenCourse::read_wiggle(Arguments &words, const std::string &name)
{
  wiggles_ = true;
  words.require(3, "wiggle dim A T");
  const int dimension = read_dimension(words, name + ": wiggle");
  amplitude_[dimension] = words.number<double>();
  wiggle_rate_ = 2 * M_PI / read_period(words, name + ": wiggle");
}

void GivenCourse::read_shear(Arguments &words)
{
  shears_ = true;
  words.require(2, "shear dim V");
  const int dimension = read_dimension(words, "shear");
  belt[dimension] = words.number<double>();
}

void GivenCourse::read_rotation(Arguments &words, const std::string &name)
{
  rotates = true;
  words.require(7, "rotate T x y z ax ay az");
  rotation_rate_ = 2 * M_PI / read_period(words, name + ": rotate");
  for (int d = 0; d < 3; ++d) point[d] = words.number<double>();
  for (int d = 0; d < 3; ++d) axis[d] = words.number<double>();
  const double size = length(axis);
  if (!(size > 0 && std::isfinite(size))) fail(name, ": rotate: the axis must be a vector other than (0, 0, 0)");
  axis = axis / size;
}

// LAMMPS' wiggle begins at rest where the wall is defined.
Place GivenCourse::at(double time) const
{
  return {amplitude_ * (1 - std::cos(wiggle_rate_ * time)), rotation_rate_ * time};
}

}    // namespace nscd
