#include "job.hpp"

#include <utility>

namespace sinew::server {
namespace {

/// Of answers told at once.
constexpr std::size_t batch_bytes = std::size_t{256} << 10U;

}  // namespace

void Job::show(std::size_t done, std::size_t total) {
  const std::lock_guard lock(mutex_);
  if (total_ == 0) begun_ = Clock::now();
  done_ = done;
  total_ = total;
}

void Job::tell(std::string question) {
  const std::lock_guard lock(mutex_);
  question_ = std::move(question);
  ++told_;
}

bool Job::add(std::string answer) {
  const std::lock_guard lock(mutex_);
  question_.clear();
  if (answer.size() > limits_.result - bytes_) return false;
  bytes_ += answer.size();
  answers_.push_back(std::move(answer));
  done_ = answers_.size();
  return true;
}

bool Job::is_over() const {
  const std::lock_guard lock(mutex_);
  return is_cancelled_ ||
         (listeners_ == 0 && Clock::now() - heard_ > std::chrono::duration<double>(limits_.patience));
}

void Job::end(Outcome outcome) {
  const std::lock_guard lock(mutex_);
  bytes_ += outcome.table.size();
  outcome_ = std::make_shared<const Outcome>(std::move(outcome));
  ended_.notify_all();
}

void Job::come() {
  const std::lock_guard lock(mutex_);
  ++listeners_;
}

void Job::leave() {
  const std::lock_guard lock(mutex_);
  --listeners_;
  heard_ = Clock::now();
}

void Job::cancel() {
  const std::lock_guard lock(mutex_);
  is_cancelled_ = true;
}

News Job::news(std::size_t position, Clock::time_point until) const {
  std::unique_lock lock(mutex_);
  ended_.wait_until(lock, until, [&] { return outcome_ || is_abandoned_; });
  News news;
  news.done = done_;
  news.total = total_;
  news.seconds = std::chrono::duration<double>(Clock::now() - begun_).count();
  news.question = question_;
  news.told = told_;
  news.outcome = outcome_;
  std::size_t next = position;
  for (; next < answers_.size() && news.text.size() < batch_bytes; ++next) {
    if (next > position) news.text += ',';
    news.text += answers_[next];
  }
  news.answers = next - position;
  news.has_more = next < answers_.size();
  return news;
}

std::size_t Job::answered() const {
  const std::lock_guard lock(mutex_);
  return answers_.size();
}

std::shared_ptr<const Outcome> Job::outcome() const {
  const std::lock_guard lock(mutex_);
  return outcome_;
}

std::size_t Job::bytes() const {
  const std::lock_guard lock(mutex_);
  return bytes_;
}

void Job::abandon() {
  const std::lock_guard lock(mutex_);
  is_cancelled_ = is_abandoned_ = true;
  ended_.notify_all();
}

bool Job::is_abandoned() const {
  const std::lock_guard lock(mutex_);
  return is_abandoned_;
}

}  // namespace sinew::server
