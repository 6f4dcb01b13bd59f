// SPDX-License-Identifier: GPL-2.0-or-later
// Warm start across ranks: with every new list, impulses go where their contacts may be solved now.
//
// A contact is solved by a rank that owns one of its grains, and which of them that is changes with their places. So
// its impulse is sent to the owners of both. Where a grain has gone so far that the rank which remembers the contact
// does not know it any more (fix balance), a rank that is found from the tag alone brings the two together: it is told
// of the impulse, and by their new owners of all grains that have arrived somewhere.
#include "warm_start/warm_start.hpp"

#include "parallel/halo.hpp"
#include "warm_start/memory_of_model.hpp"

#include <algorithm>
#include <map>
#include <tuple>

namespace nscd {

namespace {

class Post {
 public:
  std::vector<double> &to(int rank) { return letters_[rank]; }

  std::vector<Letter> letters()
  {
    std::vector<Letter> all;
    for (auto &[rank, numbers] : letters_) all.push_back({rank, std::move(numbers)});
    return all;
  }

 private:
  std::map<int, std::vector<double>> letters_;
};

template <class Entry>
void write(const Entry &entry, std::vector<double> &to)
{
  const Words<Entry> words = as_words(entry);
  to.insert(to.end(), words.begin(), words.end());
}

template <class Entry>
std::vector<Entry> read(const std::vector<Letter> &letters)
{
  constexpr std::size_t width = std::tuple_size_v<Words<Entry>>;
  std::vector<Entry> entries;
  for (const Letter &letter : letters)
    for (std::size_t k = 0; k + width <= letter.numbers.size(); k += width)
      entries.push_back(from_words<Entry>(&letter.numbers[k]));
  return entries;
}

// Impulses of grains that have gone out of sight, through the ranks that their tags name.
template <class Entry>
void find_again(Halo &halo, ImpulseMemory<Entry> &memory, const std::vector<std::pair<std::int32_t, Entry>> &lost)
{
  const auto meeting_place = [&](std::int32_t tag) { return tag % halo.ranks().count(); };
  Post impulses, arrivals, found;
  for (const auto &[tag, entry] : lost) {
    std::vector<double> &to = impulses.to(meeting_place(tag));
    to.push_back(tag);
    write(entry, to);
  }
  for (const std::int32_t tag : halo.arrivals()) arrivals.to(meeting_place(tag)).push_back(tag);
  std::map<std::int32_t, int> homes;
  for (const Letter &letter : halo.deliver(arrivals.letters()))
    for (const double tag : letter.numbers) homes[std::int32_t(tag)] = letter.rank;
  constexpr std::size_t width = 1 + std::tuple_size_v<Words<Entry>>;
  for (const Letter &letter : halo.deliver(impulses.letters()))
    for (auto at = letter.numbers.begin(); at != letter.numbers.end(); at += width) {
      const auto home = homes.find(std::int32_t(*at));
      if (home == homes.end()) continue;
      std::vector<double> &to = found.to(home->second);
      to.insert(to.end(), at + 1, at + width);
    }
  for (const Entry &entry : read<Entry>(halo.deliver(found.letters()))) memory.add(entry);
}

template <class Entry>
void follow(Halo &halo, ImpulseMemory<Entry> &memory)
{
  Post post;
  std::vector<std::pair<std::int32_t, Entry>> lost;
  memory.for_each([&](const Entry &entry) {
    for (const std::int32_t tag : tags_of(entry.key)) {
      if (tag == 0) continue;
      const int home = halo.home_of(tag);
      if (home < 0) lost.push_back({tag, entry});
      else if (home != halo.ranks().rank()) write(entry, post.to(home));
    }
  });
  for (const Entry &entry : read<Entry>(halo.deliver(post.letters()))) memory.add(entry);
  if (halo.sum(double(lost.size())) > 0) find_again(halo, memory, lost);
}

}    // namespace

void WarmStart::follow_grains(Halo &halo, Model model)
{
  with_entry(model, [&]<class E>(E) { follow(halo, std::get<ImpulseMemory<E>>(memories_)); });
}

}    // namespace nscd
