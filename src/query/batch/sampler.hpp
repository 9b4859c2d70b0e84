/// @file sampler.hpp
/// Who computes samples. The executors know nothing else of a robot.
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

#include "query/batch/batch_question.hpp"
#include "sinew/solve/report.hpp"

namespace sinew::inline v1 {

struct Context;
class RowPlaces;

/// How a sample ended: a Status, or why no solver was asked.
using SampleStatus = std::uint8_t;
inline constexpr SampleStatus refused = 8;         ///< the query at this sample is no good one
inline constexpr SampleStatus failed_inside = 9;   ///< an error of the program
inline constexpr SampleStatus left_out = 10;       ///< a derived value is outside its limits; nobody asked
inline constexpr SampleStatus not_supported = 11;  ///< the robot, or its model, has no answer to the query
inline constexpr SampleStatus not_computed = 254;  ///< its block was stopped; in no file
inline constexpr SampleStatus converged = static_cast<SampleStatus>(Status::converged);
inline constexpr SampleStatus unstable = static_cast<SampleStatus>(Status::unstable);
std::string_view name_of(SampleStatus status);
inline constexpr int sample_statuses = 12;

/// Of a solver. Numbers above the first eight mean other things in files of results than in a Report.
inline SampleStatus sample_status(Status status) {
  if (status == Status::stopped) return not_computed;
  return status <= Status::converged ? static_cast<SampleStatus>(status) : refused;
}

/// One number of every row, as it lies in memory.
template <class Number>
struct SampleColumn {
  Number* data = nullptr;
  std::ptrdiff_t stride = sizeof(double);  ///< bytes from row to row

  Number& operator[](std::size_t row) const {
    using Byte = std::conditional_t<std::is_const_v<Number>, const char, char>;
    return *reinterpret_cast<Number*>(reinterpret_cast<Byte*>(data) +
                                      static_cast<std::ptrdiff_t>(row) * stride);
  }
};
using InputColumns = std::vector<SampleColumn<const double>>;
using OutputColumns = std::vector<SampleColumn<double>>;

/// Those of `count` rows, column after column.
template <class Number>
void place_columns(std::span<Number> values, std::size_t count, std::vector<SampleColumn<Number>>& columns) {
  columns.clear();
  for (std::size_t first = 0; first + count <= values.size() && count > 0; first += count)
    columns.push_back({values.data() + first});
}

/// Samples of one chunk: some rows of all columns.
struct SampleBlock {
  std::size_t count = 0;
  std::span<const SampleColumn<const double>> inputs;
  std::span<const SampleColumn<double>>
      outputs;                               ///< a sampler writes all of them, NaN where there is no value
  std::span<SampleStatus> statuses;          ///< of these rows alone
  std::atomic<std::size_t>* done = nullptr;  ///< counts samples, for the progress
  const std::atomic<bool>* stop = nullptr;   ///< true: the block is of no more use
  std::size_t first = 0;                     ///< row of the columns

  double input(std::size_t i, std::size_t k) const { return inputs[i][first + k]; }
  double& output(std::size_t o, std::size_t k) const { return outputs[o][first + k]; }
};

/// Computes a block, in its order. Not for two threads at once. Nothing of earlier blocks shows in the bytes
/// of a later one.
using Sampler = std::function<void(const SampleBlock&)>;

/// Makes samplers, one a thread, and says how large chunks should be.
struct SamplerKind {
  std::string_view name;  ///< for people: `lanes`
  struct {
    std::size_t least = 1, most = 1;
  } chunks = {};  ///< bounds of samples, which the cost of a sample sets
  std::function<Sampler()> make;
};

/// Samples of a chunk, about: so many that there are this many chunks, within the bounds.
std::size_t chunk_size(const SamplerKind& kind, std::size_t samples, std::size_t chunks = 256);

/// Each sample by its own query: any robot, any query, any output.
SamplerKind query_sampler(const BatchQuestion& question);

/// @name Plans
/// Of a question that its mechanics read: what computes its rows without asking each. Empty `make` where the
/// question asks for more or less than they know.
/// @{
SamplerKind plan_rods(Context& context,
                      const RowPlaces& rows);  ///< forward, eight stretches of rows in lanes
SamplerKind plan_poses(Context& context, const RowPlaces& rows);     ///< inverse and velocity, in lanes
SamplerKind plan_sections(Context& context, const RowPlaces& rows);  ///< of serial robots, in lanes
SamplerKind plan_arms(Context& context,
                      const RowPlaces& rows);  ///< equilibria, in lanes where tensions are held
/// @}

/// The quickest there is.
SamplerKind choose_sampler(const BatchQuestion& question);

}  // namespace sinew::inline v1
