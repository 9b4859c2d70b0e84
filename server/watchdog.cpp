#include "watchdog.hpp"

#include <chrono>
#include <utility>

namespace sinew::server {

using namespace std::chrono_literals;

constexpr auto period = 20ms;

Watchdog::Watched::Watched(Watchdog& dog, IsOver is_over) : dog_(&dog), asks_(std::move(is_over)) {
  const std::lock_guard lock(dog.mutex_);
  is_over_ = dog.is_stopped_;
  place_ = dog.watched_.insert(dog.watched_.end(), this);
  dog.has_come_ = true;
  if (std::exchange(dog.is_asleep_, false)) dog.changed_.notify_one();
}

Watchdog::Watched::~Watched() {
  const std::lock_guard lock(dog_->mutex_);
  dog_->watched_.erase(place_);
}

void Watchdog::Watched::renew(const std::function<void()>& prepare) {
  const std::lock_guard lock(dog_->mutex_);  // not while it is asked about what went before
  prepare();
  is_over_ = dog_->is_stopped_;
}

Watchdog::Watchdog() : thread_([this](const std::stop_token& end) { look(end); }) {}

void Watchdog::stop() {
  const std::lock_guard lock(mutex_);
  is_stopped_ = true;
  for (Watched* one : watched_) one->is_over_ = true;
}

void Watchdog::look(const std::stop_token& end) {
  std::unique_lock lock(mutex_);
  while (!end.stop_requested()) {
    if (watched_.empty() && !std::exchange(has_come_, false)) {
      is_asleep_ = true;
      changed_.wait(lock, end, [&] { return !is_asleep_; });
    }
    changed_.wait_for(lock, end, period, [] { return false; });
    for (Watched* one : watched_)
      if (!one->is_over() && one->asks_()) one->is_over_ = true;
  }
}

}  // namespace sinew::server
