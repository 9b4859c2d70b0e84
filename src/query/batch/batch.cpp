#include "sinew/query/batch.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <thread>
#include <vector>

#include "query/batch/batch_state.hpp"
#include "query/batch/placeholders.hpp"
#include "query/tree_session.hpp"
#include "sinew/base/numbers.hpp"

namespace sinew::inline v1 {
namespace {

/// What a thread computes a chunk in.
struct Memory {
  std::vector<double> inputs, outputs;
  std::vector<SampleStatus> statuses;
};

/// Each number of each field by itself.
template <class Number>
std::vector<Batch::Strided<Number>> single_numbers(std::span<const Batch::Field> fields,
                                                   std::span<const Batch::Strided<Number>> arrays) {
  std::vector<Batch::Strided<Number>> single;
  for (std::size_t f = 0; f < fields.size(); ++f)
    for (std::size_t i = 0; i < fields[f].size(); ++i) single.push_back({&arrays[f](0, i), arrays[f].stride});
  return single;
}

std::uint8_t status_of(SampleStatus status) {
  if (status == not_computed) return static_cast<std::uint8_t>(Status::stopped);
  if (status == refused) return static_cast<std::uint8_t>(Status::bad_input);
  if (status == failed_inside) return Batch::failed;
  return status;
}

}  // namespace

Batch::Batch(std::shared_ptr<const State> state) : state_(std::move(state)) {}

std::span<const Batch::Field> Batch::inputs() const { return state_->inputs; }
std::span<const Batch::Field> Batch::outputs() const { return state_->outputs; }
std::string_view Batch::method() const { return state_->kind.name; }

void Batch::run(std::size_t rows, std::span<const Strided<const double>> from,
                std::span<const Strided<double>> to, std::span<std::uint8_t> statuses,
                const Options& options) const {
  if (from.size() != state_->inputs.size() || to.size() != state_->outputs.size() ||
      (!statuses.empty() && statuses.size() != rows) || rows == 0)
    return;
  const auto inputs = single_numbers(std::span<const Field>(state_->inputs), from);
  const auto outputs = single_numbers(std::span<const Field>(state_->outputs), to);
  const std::size_t size = chunk_size(state_->kind, rows), chunks = (rows + size - 1) / size;
  const std::atomic<bool> never{false};
  const std::atomic<bool>& stop = options.stop ? *options.stop : never;
  std::atomic<std::size_t> next{0}, done{0};
  const auto compute = [&](const Sampler& sample, std::size_t first, std::size_t count, Memory& memory) {
    memory.inputs.resize(inputs.size() * count);
    memory.outputs.assign(outputs.size() * count, not_a_number);
    memory.statuses.assign(count, not_computed);
    for (std::size_t i = 0; i < inputs.size(); ++i)
      for (std::size_t k = 0; k < count; ++k) memory.inputs[i * count + k] = inputs[i](first + k);
    if (!stop) sample({count, memory.inputs, memory.outputs, memory.statuses, &done, &stop});
    for (std::size_t o = 0; o < outputs.size(); ++o)
      for (std::size_t k = 0; k < count; ++k) outputs[o](first + k) = memory.outputs[o * count + k];
    for (std::size_t k = 0; k < count && !statuses.empty(); ++k)
      statuses[first + k] = status_of(memory.statuses[k]);
  };
  const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
  const std::size_t wanted =
      std::min(options.threads > 0 ? static_cast<std::size_t>(options.threads) : cores, chunks);
  std::vector<std::exception_ptr> thrown(wanted);
  const auto work = [&](std::size_t thread) {
    try {
      const Sampler sample = state_->kind.make();
      Memory memory;
      for (std::size_t c = next++; c < chunks; c = next++)
        compute(sample, c * size, std::min(size, rows - c * size), memory);
    } catch (...) {
      thrown[thread] = std::current_exception();
      next = chunks;
    }
  };
  {
    std::vector<std::jthread> others;
    for (std::size_t t = 1; t < wanted; ++t) others.emplace_back(work, t);
    work(0);
  }
  for (const std::exception_ptr& one : thrown)
    if (one) std::rethrow_exception(one);
}

std::string Batch::answer(std::span<const double> inputs) const {
  Document query = state_->question.query;
  for (const Placeholder& place : placeholders(query.root, state_->question.inputs))
    if (*place.input < inputs.size()) put(*place.node, inputs[*place.input]);
  auto session = TreeSession::open(state_->question.robot);
  return session ? session->answer(query).dump(-1, ' ', false, Json::error_handler_t::replace)
                 : std::string();
}

}  // namespace sinew::inline v1
