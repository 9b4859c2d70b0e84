#include "stream.hpp"

#include <fmt/format.h>

#include <string_view>
#include <utility>

namespace sinew::server {
namespace {

constexpr std::chrono::milliseconds pace{100};

std::string event(std::string_view id, std::string_view name, std::string_view data) {
  return fmt::format("id: {}\nevent: {}\ndata: {}\n\n", id, name, data);
}

std::string_view name_of(Outcome::Kind kind) {
  switch (kind) {
    case Outcome::Kind::cancelled:
      return "cancelled";
    case Outcome::Kind::failed:
      return "failed";
    case Outcome::Kind::done:
      break;
  }
  return "done";
}

}  // namespace

Stream::Stream(std::shared_ptr<Job> job, std::size_t position, double heart_beat, Places::Place place)
    : job_(std::move(job)),
      position_(position),
      heart_beat_(heart_beat),
      place_(std::move(place)) {
  job_->come();
}

Stream::~Stream() { job_->leave(); }

std::string Stream::next() {
  const News news = job_->news(position_, has_more_ ? Clock::now() : due_);
  std::string text;
  if (!std::exchange(has_begun_, true)) text += "retry: 1000\n\n";  // [ms] to come back after
  if (news.answers > 0) text += answers(news);
  has_more_ = news.has_more;
  const auto now = Clock::now();
  if (news.outcome && !has_more_)
    text += last(*news.outcome);
  else if (now >= due_ && news.total > 0)
    text += progress(news);
  if (now >= due_) due_ = now + pace;
  if (text.empty() && now - said_ > heart_beat_)
    text = ":\n\n";  // found dead by it, or kept by those between
  if (!text.empty()) said_ = now;
  return text;
}

std::string Stream::answers(const News& news) {
  const std::size_t first = std::exchange(position_, position_ + news.answers);
  return event(std::to_string(position_), "answers",
               fmt::format(R"({{"first":{},"answers":[{}]}})", first, news.text));
}

std::string Stream::progress(const News& news) {
  const bool has_said = std::exchange(heard_, news.told) != news.told && !news.question.empty();
  if (std::exchange(shown_, news.done) == news.done && !has_said) return {};
  std::string data = fmt::format(R"({{"done":{},"total":{})", news.done, news.total);
  if (const double rate = static_cast<double>(news.done) / news.seconds; rate > 0 && news.seconds > 0)
    data += fmt::format(R"(,"rate":{:.1f},"left":{:.1f})", rate,
                        static_cast<double>(news.total - news.done) / rate);
  if (!news.question.empty()) data += R"(,"question":)" + news.question;
  return event(std::to_string(position_), "progress", data + '}');
}

std::string Stream::last(const Outcome& outcome) {
  has_ended_ = true;
  return event("end", name_of(outcome.kind), outcome.said);
}

}  // namespace sinew::server
