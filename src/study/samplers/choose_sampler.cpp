#include <algorithm>

#include "study/samplers/sampler.hpp"

namespace sinew::inline v1 {

std::size_t chunk_size(const Study& study, std::size_t least, std::size_t most) {
  constexpr std::size_t chunks = 256;  // to share, to show progress by, and to lose one of
  return std::clamp(study.samples / chunks, least, most);
}

SamplerKind choose_sampler(const Study& study) {
  for (const auto& quick : {rod_sampler, pose_sampler, serial_sampler})
    if (SamplerKind kind = quick(study); kind.make) return kind;
  return query_sampler(study);
}

}  // namespace sinew::inline v1
