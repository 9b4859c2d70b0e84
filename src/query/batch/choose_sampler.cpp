#include <algorithm>

#include "query/batch/row_places.hpp"
#include "query/tree_session.hpp"

namespace sinew::inline v1 {

std::size_t chunk_size(const SamplerKind& kind, std::size_t samples, std::size_t chunks) {
  return std::clamp(samples / chunks, kind.chunks.least, kind.chunks.most);
}

SamplerKind choose_sampler(const BatchQuestion& question) {
  const auto has_words = [](const auto& words) { return !words.empty(); };
  if (std::ranges::any_of(question.words, has_words)) return query_sampler(question);
  if (auto session = TreeSession::open(question.robot))
    if (SamplerKind quick = session->plan(RowPlaces(question)); quick.make) return quick;
  return query_sampler(question);
}

}  // namespace sinew::inline v1
