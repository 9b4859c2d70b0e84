/// @file limiter.hpp
/// How much an address may ask, and how much is computed at a time.
#pragma once
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

namespace sinew::server {

/// So many queries a second of each address; a second's worth may come at once.
class Rate {
 public:
  using Clock = std::chrono::steady_clock;
  explicit Rate(double a_second) : a_second_(a_second) {}
  bool allows(const std::string& address, std::size_t queries, Clock::time_point now = Clock::now());

 private:
  struct Bucket {
    double left;
    Clock::time_point at;
  };
  double a_second_;
  std::mutex mutex_;
  std::map<std::string, Bucket> buckets_;
};

/// Bytes that all requests share: of large bodies and answers, which clients may be slow to give or to take.
class Room {
 public:
  explicit Room(std::size_t most) : left_(most) {}
  /// So many, given back with what is returned; null where they are not left.
  std::shared_ptr<const void> take(std::size_t bytes);

 private:
  std::atomic<std::size_t> left_;
};

/// Places to compute; who finds none free waits for a while.
class Places {
 public:
  explicit Places(int count) : free_(count) {}

  /// A place, given back with it.
  class Place {
   public:
    explicit Place(Places* places) : places_(places) {}
    Place(Place&& other) noexcept : places_(std::exchange(other.places_, nullptr)) {}
    Place& operator=(Place&&) = delete;
    ~Place();
    explicit operator bool() const { return places_; }

   private:
    Places* places_;
  };
  Place wait(std::chrono::duration<double> patience);

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  int free_;
};

}  // namespace sinew::server
