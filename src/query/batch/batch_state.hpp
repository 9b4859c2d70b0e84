/// @file batch_state.hpp
/// What a batch is made of.
#pragma once
#include <vector>

#include "query/batch/sampler.hpp"
#include "sinew/query/batch.hpp"

namespace sinew::inline v1 {

/// Samplers know single numbers only: those of all fields, one field after the other.
struct Batch::State {
  BatchQuestion question;
  std::vector<Field> inputs, outputs;
  SamplerKind kind;
};

}  // namespace sinew::inline v1
