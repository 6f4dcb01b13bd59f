// SPDX-License-Identifier: GPL-2.0-or-later
// Reads the triangles of an STL file, binary or ASCII. The normals that are in it are not looked at.
#pragma once

#include "base/storage.hpp"
#include "obstacle/triangle.hpp"

#include <string>

namespace nscd {

// At least one triangle, all of finite numbers; raises Error otherwise. `name` is "wall 2".
AlignedVector<Triangle> read_stl(const std::string &path, const std::string &name);

}    // namespace nscd
