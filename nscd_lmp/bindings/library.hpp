// SPDX-License-Identifier: GPL-2.0-or-later
// LAMMPS' C interface by function address, so that any LAMMPS library will do: the one that the user loaded.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

namespace nscd {

struct Library {
  void *handle = nullptr;    // lammps_open's
  void *(*extract_atom)(void *, const char *) = nullptr;
  void *(*extract_global)(void *, const char *) = nullptr;
  int (*extract_setting)(void *, const char *) = nullptr;
  void (*extract_box)(void *, double *, double *, double *, double *, double *, int *, int *) = nullptr;
  double (*get_thermo)(void *, const char *) = nullptr;
  double (*get_natoms)(void *) = nullptr;
  int (*find_pair_neighlist)(void *, const char *, int, int, int) = nullptr;
  int (*neighlist_num_elements)(void *, int) = nullptr;
  void (*neighlist_element_neighbors)(void *, int, int, int *, int *, int **) = nullptr;
  void (*force_timeout)(void *) = nullptr;
  // Of the pair style, by names of its own; null in builds before 2025.
  void *(*extract_pair)(void *, const char *) = nullptr;
  int (*id_count)(void *, const char *) = nullptr;
  int (*id_name)(void *, const char *, int, char *, int) = nullptr;

  template <class T>
  T *per_atom(const char *name) const
  {
    return static_cast<T *>(extract_atom(handle, name));
  }

  // A global quantity; LAMMPS returns its address.
  template <class T>
  T *global(const char *name) const
  {
    return static_cast<T *>(extract_global(handle, name));
  }
};

}    // namespace nscd
