// SPDX-License-Identifier: GPL-2.0-or-later
#include "restart.hpp"

#include "contact/tangents.hpp"

#include <algorithm>

namespace nscd {

void RestartRecords::collect(Step &step, int owned, const std::int32_t *tag)
{
  of_grain_.clear();
  for (int i = 0; i < owned; ++i) of_grain_[tag[i]];
  const Model model = step.state().friction.model;
  unknowns_ = unknowns(model);
  step.memory().for_each(model, [&](std::int32_t low, std::int32_t high, std::span<const double> words) {
    auto at = of_grain_.find(low);
    if (at == of_grain_.end()) at = of_grain_.find(high);
    // Both have just left for other ranks: any grain can carry it, for who reads it looks for the two.
    if (at == of_grain_.end()) at = of_grain_.begin();
    if (at != of_grain_.end()) at->second.insert(at->second.end(), words.begin(), words.end());
  });
}

int RestartRecords::size(std::int32_t tag) const
{
  const auto at = of_grain_.find(tag);
  return head + (at == of_grain_.end() ? 0 : int(at->second.size()));
}

int RestartRecords::largest() const
{
  int most = head;
  for (const auto &[tag, words] : of_grain_) most = std::max(most, head + int(words.size()));
  return most;
}

int RestartRecords::pack(std::int32_t tag, double *to) const
{
  to[0] = size(tag);
  to[1] = unknowns_;
  const auto at = of_grain_.find(tag);
  if (at != of_grain_.end()) std::copy(at->second.begin(), at->second.end(), to + head);
  return size(tag);
}

void RestartRecords::give(Step &step, std::vector<double> &records)
{
  const Model model = step.state().friction.model;
  const std::size_t width = WarmStart::words(model);
  for (std::size_t first = 0; first < records.size(); first += std::size_t(records[first])) {
    const double *record = records.data() + first;
    if (int(record[1]) != unknowns(model)) continue;
    for (std::size_t k = head; k + width <= std::size_t(record[0]); k += width)
      step.memory().add(model, {record + k, width});
  }
  records.clear();
}

}    // namespace nscd
