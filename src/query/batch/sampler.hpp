/// @file sampler.hpp
/// Who computes samples. The executors know nothing else of a robot.
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "query/batch/batch_question.hpp"
#include "sinew/solve/report.hpp"

namespace sinew::inline v1 {

/// How a sample ended: a Status, or why no solver was asked.
using SampleStatus = std::uint8_t;
inline constexpr SampleStatus refused = 8;         ///< the query at this sample is no good one
inline constexpr SampleStatus failed_inside = 9;   ///< an error of the program
inline constexpr SampleStatus left_out = 10;       ///< a derived value is outside its limits; nobody asked
inline constexpr SampleStatus not_computed = 254;  ///< its block was stopped; in no file
inline constexpr SampleStatus converged = static_cast<SampleStatus>(Status::converged);
inline constexpr SampleStatus unstable = static_cast<SampleStatus>(Status::unstable);
SINEW_API std::string_view name_of(SampleStatus status);
inline constexpr int sample_statuses = 11;

/// Samples of one chunk, column after column.
struct SampleBlock {
  std::size_t count = 0;
  std::span<const double> inputs;
  std::span<double> outputs;  ///< NaN where there is no value
  std::span<SampleStatus> statuses;
  std::atomic<std::size_t>* done = nullptr;  ///< counts samples, for the progress
  const std::atomic<bool>* stop = nullptr;   ///< true: the block is of no more use

  double input(std::size_t i, std::size_t k) const { return inputs[i * count + k]; }
  double& output(std::size_t o, std::size_t k) const { return outputs[o * count + k]; }
};

/// Computes a block, in its order. Not for two threads at once.
using Sampler = std::function<void(const SampleBlock&)>;

/// Makes samplers, one a thread, and says how large chunks should be.
struct SamplerKind {
  std::string_view name;  ///< for people: `lanes`
  struct {
    std::size_t least = 1, most = 1;
  } chunks = {};  ///< bounds of samples, which the cost of a sample sets
  std::function<Sampler()> make;
};

/// Samples of a chunk, about: so many that there are some hundred chunks, within the bounds.
SINEW_API std::size_t chunk_size(const SamplerKind& kind, std::size_t samples);

/// Each sample by its own query: any robot, any query, any output.
SINEW_API SamplerKind query_sampler(const BatchQuestion& question);

/// Forward kinematics of rods, eight stretches of samples in the lanes; empty `make` where the question asks
/// for more or less than that.
SamplerKind rod_sampler(const BatchQuestion& question);

/// Inverse kinematics and velocity analysis of poses in lanes; likewise.
SamplerKind pose_sampler(const BatchQuestion& question);

/// Tendon changes of serial robots in lanes; likewise.
SamplerKind serial_sampler(const BatchQuestion& question);

/// The quickest there is.
SINEW_API SamplerKind choose_sampler(const BatchQuestion& question);

}  // namespace sinew::inline v1
