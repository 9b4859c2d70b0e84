#include "feed.hpp"

#include <algorithm>
#include <utility>

namespace sinew::server::device {
namespace {

constexpr std::chrono::milliseconds patience{100};

std::string event_text(std::string_view name, std::string_view data) {
  std::string text = "event: ";
  text += name;
  text += "\ndata: ";
  text += data;
  return text + "\n\n";
}

}  // namespace

void Feed::publish(std::string frame) {
  const std::lock_guard lock(mutex_);
  frame_ = std::move(frame);
  ++frames_;
  changed_.notify_all();
}

void Feed::log(std::string entry) {
  const std::lock_guard lock(mutex_);
  log_.push_back(std::move(entry));
  if (log_.size() > kept) log_.pop_front();
  ++entries_;
  changed_.notify_all();
}

void Feed::stop() {
  const std::lock_guard lock(mutex_);
  is_stopped_ = true;
  changed_.notify_all();
}

std::string FeedStream::next() {
  std::unique_lock lock(feed_->mutex_);
  feed_->changed_.wait_for(lock, patience, [&] {
    return feed_->is_stopped_ || feed_->frames_ != frames_ || feed_->entries_ != entries_;
  });
  std::string text;
  if (!std::exchange(has_begun_, true)) text += "retry: 1000\n\n";  // [ms] to come back after
  const std::uint64_t missing = std::min<std::uint64_t>(feed_->entries_ - entries_, feed_->log_.size());
  for (std::size_t i = feed_->log_.size() - missing; i < feed_->log_.size(); ++i)
    text += event_text("log", feed_->log_[i]);
  entries_ = feed_->entries_;
  if (std::exchange(frames_, feed_->frames_) != feed_->frames_) text += event_text("frame", feed_->frame_);
  return text;
}

bool FeedStream::is_broken() const {
  const std::lock_guard lock(feed_->mutex_);
  return feed_->is_stopped_;
}

}  // namespace sinew::server::device
