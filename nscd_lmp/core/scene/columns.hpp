// SPDX-License-Identifier: GPL-2.0-or-later
// A table whose columns are arrays of their own: one place that makes them longer or shorter and lets rows change
// places. A column is open, and then has an entry for each row, or closed, and then has none.
#pragma once

#include "base/hot.hpp"
#include "base/storage.hpp"

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace nscd {

// Has the addresses of its columns, so it stays where it is.
class Columns {
 public:
  class Any;
  Columns() = default;
  Columns(const Columns &) = delete;
  Columns &operator=(const Columns &) = delete;

  // Rows.
  std::size_t size() const { return rows_; }
  bool empty() const { return rows_ == 0; }
  // Keeps the first rows; what is new in open columns is T{}.
  void resize(std::size_t rows);
  void swap(std::size_t a, std::size_t b);
  // Of memory, entries kept in reserve included.
  std::size_t bytes() const;
  std::span<Any *const> all() const { return all_; }

 private:
  std::size_t rows_ = 0;
  std::vector<Any *> all_;
};

// A column, whatever it holds.
class Columns::Any {
 public:
  Any(const Any &) = delete;
  Any &operator=(const Any &) = delete;

  bool is_open() const { return open_; }
  // New entries are T{}; an open column keeps its own.
  void open();
  // Keeps the memory.
  void close();
  virtual std::size_t size() const = 0;

 protected:
  enum class Starts { open, closed };
  Any(Columns &table, Starts starts);
  ~Any() = default;

 private:
  friend class Columns;
  virtual void set_size(std::size_t rows) = 0;
  virtual void swap(std::size_t a, std::size_t b) = 0;
  virtual std::size_t bytes() const = 0;

  const Columns &table_;
  bool open_;
};

// Entries are there to be read and written; their number is the table's.
template <class T>
class Column : public Columns::Any {
 public:
  explicit Column(Columns &table) : Column(table, Starts::open) {}

  std::size_t size() const final { return entries_.size(); }
  NSCD_INLINE T &operator[](std::size_t k) { return entries_[k]; }
  NSCD_INLINE const T &operator[](std::size_t k) const { return entries_[k]; }
  T *data() { return entries_.data(); }
  const T *data() const { return entries_.data(); }
  T *begin() { return data(); }
  T *end() { return data() + size(); }
  const T *begin() const { return data(); }
  const T *end() const { return data() + size(); }
  std::span<T> all() { return {data(), size()}; }
  std::span<const T> all() const { return {data(), size()}; }

 protected:
  Column(Columns &table, Starts starts) : Any(table, starts) {}

 private:
  void set_size(std::size_t rows) final { resize_closely(entries_, rows); }
  void swap(std::size_t a, std::size_t b) final { std::swap(entries_[a], entries_[b]); }
  std::size_t bytes() const final { return entries_.capacity() * sizeof(T); }

  AlignedVector<T> entries_;
};

// One that only some scenes, or some moments of a step, have: closed until it is opened.
template <class T>
class ColumnAtTimes : public Column<T> {
 public:
  explicit ColumnAtTimes(Columns &table) : Column<T>(table, Column<T>::Starts::closed) {}
};

}    // namespace nscd
