#include "sinew/batch.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <thread>
#include <vector>

#include "query/batch/batch_state.hpp"
#include "query/batch/placeholders.hpp"
#include "query/fields/fields.hpp"
#include "query/tree_session.hpp"
#include "query/wants.hpp"
#include "sinew/base/numbers.hpp"

namespace sinew::inline v1 {
namespace {

/// Each number of each field by itself.
template <class Number>
void place_columns(std::span<const Batch::Field> fields, std::span<const Batch::Strided<Number>> arrays,
                   std::vector<SampleColumn<Number>>& columns) {
  columns.clear();
  for (std::size_t f = 0; f < fields.size(); ++f)
    for (std::size_t i = 0, count = fields[f].size(); i < count; ++i)
      columns.push_back({&arrays[f](0, i), arrays[f].stride});
}

std::uint8_t status_of(SampleStatus status) {
  if (status <= converged) return status;
  if (status == not_computed) return static_cast<std::uint8_t>(Status::stopped);
  if (status == not_supported) return static_cast<std::uint8_t>(Status::unsupported);
  return status == refused ? static_cast<std::uint8_t>(Status::bad_input) : Batch::failed;
}

/// Rows, and where they lie.
struct Rows {
  std::size_t count, chunk;
  std::span<const SampleColumn<const double>> inputs;
  std::span<const SampleColumn<double>> outputs;
  std::span<std::uint8_t> statuses;  ///< may be empty
  const std::atomic<bool>* stop;

  std::size_t chunks() const { return (count + chunk - 1) / chunk; }

  void compute(std::size_t number, BatchMemory& memory) const {
    const std::size_t first = number * chunk, size = std::min(chunk, count - first);
    if (statuses.empty()) memory.statuses.resize(size);
    const auto own = statuses.empty() ? std::span(memory.statuses) : statuses.subspan(first, size);
    std::ranges::fill(own, not_computed);
    std::atomic<std::size_t> done{0};
    if (!*stop) memory.sample({size, inputs, outputs, own, &done, stop, first});
    for (std::size_t k = 0; k < size; ++k) {
      if (own[k] == not_computed)
        for (const auto& column : outputs) column[first + k] = not_a_number;
      own[k] = status_of(own[k]);
    }
  }
};

/// On threads of their own; throws what one of them throws.
void compute_on_threads(const Rows& rows, std::size_t threads, BatchMemories& memories,
                        const SamplerKind& kind) {
  std::atomic<std::size_t> next{0};
  std::vector<std::exception_ptr> thrown(threads);
  const auto work = [&](std::size_t thread) {
    try {
      const BatchMemories::Lent memory(memories, kind);
      for (std::size_t c = next++; c < rows.chunks(); c = next++) rows.compute(c, *memory);
    } catch (...) {
      thrown[thread] = std::current_exception();
      next = rows.chunks();
    }
  };
  {
    std::vector<std::jthread> others;
    for (std::size_t t = 1; t < threads; ++t) others.emplace_back(work, t);
    work(0);
  }
  for (const std::exception_ptr& one : thrown)
    if (one) std::rethrow_exception(one);
}

}  // namespace

std::size_t Batch::Field::size() const {
  std::size_t numbers = 1;
  for (const std::size_t length : shape) numbers *= length;
  return numbers;
}

Batch::Batch(std::shared_ptr<const State> state) : state_(std::move(state)) {}

std::span<const Batch::Field> Batch::inputs() const { return state_->inputs; }
std::span<const Batch::Field> Batch::outputs() const { return state_->outputs; }
std::vector<std::string_view> Batch::wants() const {
  const Wants named = named_wants(state_->question.query.root);
  const auto words = find_field("want")->words;
  std::vector<std::string_view> found;
  for (std::size_t k = 0; k < words.size(); ++k)
    if (named.has(static_cast<Want>(k))) found.push_back(words[k]);
  return found;
}

std::string_view Batch::method() const { return state_->kind.name; }

void Batch::run(std::size_t rows, std::span<const Strided<const double>> inputs,
                std::span<const Strided<double>> outputs, std::span<std::uint8_t> statuses,
                const Options& options) const {
  if (inputs.size() != state_->inputs.size() || outputs.size() != state_->outputs.size() ||
      (!statuses.empty() && statuses.size() != rows) || rows == 0)
    return;
  static constexpr std::atomic<bool> never{false};
  constexpr std::size_t most_chunks = 64;  // to share; each begins anew
  const BatchMemories::Lent memory(state_->memories, state_->kind);
  place_columns<const double>(state_->inputs, inputs, memory->inputs);
  place_columns<double>(state_->outputs, outputs, memory->outputs);
  const Rows all{rows,     chunk_size(state_->kind, rows, most_chunks), memory->inputs, memory->outputs,
                 statuses, options.stop ? options.stop : &never};
  std::size_t threads = options.threads > 0 ? static_cast<std::size_t>(options.threads) : 0;
  if (threads == 0 && all.chunks() > 1) threads = std::max(1U, std::thread::hardware_concurrency());
  threads = std::min(threads, all.chunks());
  if (threads > 1) return compute_on_threads(all, threads, state_->memories, state_->kind);
  for (std::size_t c = 0; c < all.chunks(); ++c) all.compute(c, *memory);
}

std::string Batch::answer(std::span<const double> inputs) const {
  Document query = state_->question.query;
  for (const Placeholder& place : placeholders(query.root, state_->question.inputs))
    if (*place.input < inputs.size()) put(*place.node, inputs[*place.input]);
  auto session = TreeSession::open(state_->question.robot);
  return session ? session->answer(query).json() : std::string();
}

}  // namespace sinew::inline v1
