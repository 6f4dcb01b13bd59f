// SPDX-License-Identifier: GPL-2.0-or-later
// The materials of a scene: what holds between two types of atoms, and between a grain and a wall.
#pragma once

#include "base/arguments.hpp"
#include "contact/material.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace nscd {

struct Settings;

// Types of atoms as LAMMPS' pair_coeff names them: "2", "*", "2*", "*3", "2*4"; from 1.
struct TypeRange {
  int first = 1, last = 0;   // last 0: the largest there is
};

// What pairs of these types have of their own, whichever of the two is the other.
struct PairMaterial {
  std::string types;   // as they were written
  TypeRange i, j;
  OwnMaterial own;
};

// What holds between two types that have materials of their own where their pair has none.
enum class Mixing { none, geometric, arithmetic };

// Takes the next number that `own` has not yet, as "friction 0.5"; returns false if the next word is none of those.
bool read_own_part(OwnMaterial &own, Arguments &words);
// Reads "friction 0.5 restitution 0.2"; raises Error for other words. And back.
OwnMaterial read_own_material(const std::vector<std::string> &words);
// Of a word that is not to be there, or stands there twice.
[[noreturn]] void refuse_own_word(const std::string &word, const std::string &choices);
std::string written(const OwnMaterial &own);

class Materials {
 public:
  // `types`: of atoms, 1 to types. Raises Error for a type that is not there, where two types have materials of their
  // own and their pair has none (unless they are mixed), and for what has no effect.
  Materials(const Settings &settings, int types);

  // Whether pairs of different types differ; if not, types are not looked at.
  bool by_type() const { return by_type_; }
  // Of two types, from 1.
  MaterialNumber of_pair(int a, int b) const { return pairs_[std::size_t(a * (types_ + 1) + b)]; }
  // Of all pairs, where they are alike.
  MaterialNumber of_pairs() const { return pairs_.back(); }
  // Walls are counted from 0.
  MaterialNumber of_wall(int wall) const { return walls_[std::size_t(wall)]; }
  const Material &operator[](MaterialNumber number) const { return all_[number]; }
  std::span<const Material> all() const { return all_; }

  // Whether Newton's law may make energy where several of these impacts meet (step/energy_limit.hpp): not with one e
  // for all contacts and, where there is friction, e_t = e.
  bool may_make_energy() const { return may_make_energy_; }

 private:
  void require_pairs_named(const Settings &settings) const;
  void require_effects(const Settings &settings) const;
  MaterialNumber number_of(const Material &material);
  Material of_types(const Settings &settings, int a, int b) const;

  int types_;
  std::vector<Material> all_;             // each once
  std::vector<MaterialNumber> pairs_;     // (types + 1, types + 1), symmetric; row and column 0 of none
  std::vector<MaterialNumber> walls_;
  bool by_type_ = false, may_make_energy_ = false;
};

}    // namespace nscd
