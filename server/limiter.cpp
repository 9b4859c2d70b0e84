#include "limiter.hpp"

#include <algorithm>

namespace sinew::server {

bool Rate::allows(const std::string& address, std::size_t queries, Clock::time_point now) {
  constexpr std::size_t max_addresses = 1000;
  const std::lock_guard lock(mutex_);
  if (buckets_.size() > max_addresses) buckets_.clear();
  Bucket& bucket = buckets_.try_emplace(address, Bucket{a_second_, now}).first->second;
  const double passed = std::chrono::duration<double>(now - bucket.at).count();
  bucket = {std::min(a_second_, bucket.left + passed * a_second_), now};
  if (bucket.left < static_cast<double>(queries)) return false;
  bucket.left -= static_cast<double>(queries);
  return true;
}

std::shared_ptr<const void> Room::take(std::size_t bytes) {
  std::size_t left = left_;
  do {
    if (bytes > left) return nullptr;
  } while (!left_.compare_exchange_weak(left, left - bytes));
  return {this, [bytes](Room* room) { room->left_ += bytes; }};
}

Places::Place Places::wait(std::chrono::duration<double> patience) {
  std::unique_lock lock(mutex_);
  if (!changed_.wait_for(lock, patience, [&] { return free_ > 0; })) return Place(nullptr);
  --free_;
  return Place(this);
}

Places::Place::~Place() {
  if (!places_) return;
  {
    const std::lock_guard lock(places_->mutex_);
    ++places_->free_;
  }
  places_->changed_.notify_one();
}

}  // namespace sinew::server
