#include "study/samplers/sampler.hpp"

namespace sinew::inline v0 {

SamplerKind choose_sampler(const Study& study) {
  for (const auto& quick : {rod_sampler, pose_sampler})
    if (SamplerKind kind = quick(study); kind.make) return kind;
  return query_sampler(study);
}

}  // namespace sinew::inline v0
