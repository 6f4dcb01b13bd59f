// SPDX-License-Identifier: GPL-2.0-or-later
// The contacts of a step, with all that lies beside them. A new array beside contacts is a line here, and nothing else
// has to know that it grows and is put in order with the others.
#pragma once

#include "contact/contact.hpp"
#include "contact/mechanics.hpp"
#include "contact/material.hpp"
#include "scene/columns.hpp"

#include <type_traits>

namespace nscd {

struct ContactTable : Columns {
  Column<Contact> contacts{*this};
  Column<ContactInfo> infos{*this};
  ColumnAtTimes<Slide<Planar>> planar{*this};         // with friction one of the two
  ColumnAtTimes<Slide<Spatial>> spatial{*this};
  ColumnAtTimes<MaterialNumber> material{*this};      // where something looks at it beside mu, which slides have
  ColumnAtTimes<double> per_approach{*this};          // 1 / the approach that a step may leave, s/m; or closed: any
  // Of impacts that are resolved ahead of the contacts, while and after they are: N s.
  ColumnAtTimes<double> impact_impulse{*this};
  ColumnAtTimes<Vec4> impact_tangential{*this};       // with friction
  // Of the first contacts, those of a round of impacts:
  ColumnAtTimes<double> impact_moment{*this};         // when they meet, s after the start of the step
  ColumnAtTimes<double> impact_kick{*this};           // m/s: n.u when they meet, less n.u in the middle of the step

  void open_slides(Model model)
  {
    if (model == Model::planar) planar.open();
    if (model == Model::spatial) spatial.open();
  }
  void close_impacts() { impact_impulse.close(), impact_tangential.close(); }

  template <class M>
  auto &slides()
  {
    if constexpr (std::is_same_v<M, Planar>) return planar;
    else return spatial;
  }
  template <class M>
  const auto &slides() const
  {
    if constexpr (std::is_same_v<M, Planar>) return planar;
    else return spatial;
  }
};

}    // namespace nscd
