// SPDX-License-Identifier: GPL-2.0-or-later
// What two surfaces do to each other where they touch: numbers of the contact, by its pair of materials or by its wall.
//
// A new one is a member of Material and a line of material_parts: keywords, walls, pairs and doors then have it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>

namespace nscd {

// Friction coefficient of contacts that do not slip.
constexpr double stick = std::numeric_limits<double>::infinity();

struct Material {
  double friction = 0;      // Coulomb's mu; may be `stick`
  double restitution = 0;   // Newton's e, 0..1
  double e_t = 0;           // tangential restitution, 0..1
};

struct MaterialPart {
  std::string_view name;
  double Material::*value;
};
constexpr std::array material_parts{
    MaterialPart{"friction", &Material::friction},
    MaterialPart{"restitution", &Material::restitution},
    MaterialPart{"e_t", &Material::e_t},
};

// Some of those numbers: what a wall or a pair has of its own.
class OwnMaterial {
 public:
  void set(std::size_t part, double value)
  {
    values_.*material_parts[part].value = value;
    given_[part] = true;
  }
  bool has(std::size_t part) const { return given_[part]; }
  double value(std::size_t part) const { return values_.*material_parts[part].value; }

  // `others`, with its own numbers in place of theirs.
  Material over(const Material &others) const
  {
    Material all = others;
    for (std::size_t part = 0; part < material_parts.size(); ++part)
      if (given_[part]) all.*material_parts[part].value = value(part);
    return all;
  }

 private:
  Material values_{};
  std::array<bool, material_parts.size()> given_{};
};

// A contact has the number of its material: two bytes, where it would take eight for each of its parts.
using MaterialNumber = std::uint16_t;

// The materials of contacts, beside them; or empty.
struct MaterialsOf {
  std::span<const MaterialNumber> numbers{};
  std::span<const Material> materials{};

  bool empty() const { return numbers.empty(); }
  const Material &operator[](std::size_t k) const { return materials[numbers[k]]; }
};

}    // namespace nscd
