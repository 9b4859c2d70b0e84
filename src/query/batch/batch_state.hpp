/// @file batch_state.hpp
/// What a batch is made of.
#pragma once
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "query/batch/sampler.hpp"
#include "sinew/batch.hpp"

namespace sinew::inline v1 {

/// What a thread computes in. It is kept from run to run, so that a row by itself allocates nothing.
struct BatchMemory {
  Sampler sample;
  InputColumns inputs;
  OutputColumns outputs;
  std::vector<SampleStatus> statuses;
};

/// Memories that no thread computes in now.
class BatchMemories {
 public:
  /// One of them, back when it goes out of scope; one in which something was thrown does not come back.
  class Lent {
   public:
    Lent(BatchMemories& from, const SamplerKind& kind) : from_(&from), memory_(from.take(kind)) {}
    Lent(const Lent&) = delete;
    Lent& operator=(const Lent&) = delete;
    ~Lent() {
      if (std::uncaught_exceptions() == thrown_) from_->give(std::move(memory_));
    }
    BatchMemory* operator->() const { return memory_.get(); }
    BatchMemory& operator*() const { return *memory_; }

   private:
    BatchMemories* from_;
    std::unique_ptr<BatchMemory> memory_;
    int thrown_ = std::uncaught_exceptions();
  };

 private:
  std::unique_ptr<BatchMemory> take(const SamplerKind& kind) {
    {
      const std::scoped_lock lock(mutex_);
      if (!idle_.empty()) {
        auto memory = std::move(idle_.back());
        idle_.pop_back();
        return memory;
      }
    }
    auto memory = std::make_unique<BatchMemory>();
    memory->sample = kind.make();
    return memory;
  }
  void give(std::unique_ptr<BatchMemory> memory) noexcept {
    try {
      const std::scoped_lock lock(mutex_);
      idle_.push_back(std::move(memory));
    } catch (const std::exception&) {  // no room to keep it: the next run makes another
    }
  }

  std::mutex mutex_;
  std::vector<std::unique_ptr<BatchMemory>> idle_;
};

/// Samplers know single numbers only: those of all fields, one field after the other.
struct Batch::State {
  BatchQuestion question;
  std::vector<Field> inputs, outputs;
  SamplerKind kind;
  mutable BatchMemories memories = {};
};

}  // namespace sinew::inline v1
