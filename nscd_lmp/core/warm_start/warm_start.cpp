// SPDX-License-Identifier: GPL-2.0-or-later
#include "warm_start/warm_start.hpp"

#include "scene/slides.hpp"
#include "warm_start/memory_of_model.hpp"

namespace nscd {

void WarmStart::remember(State &s)
{
  with_mechanics(sliding(s), s.motion.bodies.data(), [&]<class M>(const M &mechanics) {
    nscd::remember(std::get<Memory<M>>(memories_), mechanics, s.table.contacts.all(), s.table.infos.all());
  });
}

void WarmStart::recall(State &s, std::size_t first) const
{
  with_mechanics(sliding(s), s.motion.bodies.data(), [&]<class M>(const M &mechanics) {
    nscd::recall(std::get<Memory<M>>(memories_), mechanics, s.table.contacts.all(), s.table.infos.all(), first);
  });
}

std::size_t WarmStart::words(Model model)
{
  return with_entry(model, []<class E>(E) { return std::tuple_size_v<Words<E>>; });
}

void WarmStart::for_each(Model model, const Visit &visit) const
{
  with_entry(model, [&]<class E>(E) {
    std::get<ImpulseMemory<E>>(memories_).for_each([&](const E &entry) {
      const auto tags = tags_of(entry.key);
      const Words<E> words = as_words(entry);
      visit(tags[0], tags[1], words);
    });
  });
}

void WarmStart::add(Model model, std::span<const double> words)
{
  with_entry(model, [&]<class E>(E) { std::get<ImpulseMemory<E>>(memories_).add(from_words<E>(words.data())); });
}

}    // namespace nscd
