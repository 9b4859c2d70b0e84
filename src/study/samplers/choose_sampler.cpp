#include "study/samplers/sampler.hpp"

namespace sinew::inline v0 {

SamplerKind choose_sampler(const Study& study) {
  if (SamplerKind rods = rod_sampler(study); rods.make) return rods;
  return query_sampler(study);
}

}  // namespace sinew::inline v0
