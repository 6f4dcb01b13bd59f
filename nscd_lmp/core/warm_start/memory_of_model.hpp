// SPDX-License-Identifier: GPL-2.0-or-later
// What the contacts of a scene are remembered by.
#pragma once

#include "warm_start/remembered.hpp"

namespace nscd {

// Calls f with an entry.
template <class Function>
auto with_entry(Model model, Function f)
{
  switch (model) {
    case Model::planar: return f(Entry<Frictional<Planar>>{});
    case Model::spatial: return f(Entry<Frictional<Spatial>>{});
    default: return f(Entry<Frictionless>{});
  }
}

}    // namespace nscd
