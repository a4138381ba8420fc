#include "common/transport.hpp"

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace hairpin {

class Transport::RawSubscription {
 public:
  RawSubscription(Transport& transport, const std::string& regex, RawHandler handler)
      : transport_(transport), handler_(std::move(handler)) {
    subscription_ = transport_.lcm_.subscribe(regex, &RawSubscription::OnMessage, this);
    if (subscription_ == nullptr) throw std::runtime_error("cannot subscribe to " + regex);
    subscription_->setQueueCapacity(kQueueCapacity);
  }
  ~RawSubscription() { transport_.lcm_.unsubscribe(subscription_); }
  RawSubscription(const RawSubscription&) = delete;
  RawSubscription& operator=(const RawSubscription&) = delete;

 private:
  // LCM drops the newest when the queue is full; this holds a second of every channel of the car.
  static constexpr int kQueueCapacity = 1000;

  void OnMessage(const lcm::ReceiveBuffer* buffer, const std::string& channel) {
    if (transport_.error_) return;
    try {
      handler_(channel, static_cast<const uint8_t*>(buffer->data), buffer->data_size);
    } catch (...) {
      transport_.error_ = std::current_exception();
    }
  }

  Transport& transport_;
  RawHandler handler_;
  lcm::Subscription* subscription_ = nullptr;
};

Transport::Transport(const std::string& url) : url_(url), lcm_(url) {
  if (lcm_.good()) return;
  throw std::runtime_error(
      "cannot open " + url +
      " (is there a multicast route? `ip link set lo up; ip route add 224.0.0.0/4 dev lo`)");
}

bool Transport::Handle(int timeout_ms) {
  const int handled = lcm_.handleTimeout(timeout_ms);
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
  // An interrupted wait is how Ctrl-C looks from here; the caller's loop knows what to do.
  if (handled < 0 && errno != EINTR)
    throw std::runtime_error(url_ + ": receiving failed: " + std::strerror(errno));
  return handled > 0;
}

void Transport::Drain() {
  while (Handle(0)) {
  }
}

std::shared_ptr<Transport::RawSubscription> Transport::Subscribe(const std::string& channel_regex,
                                                                 RawHandler handler) {
  return std::make_shared<RawSubscription>(*this, channel_regex, std::move(handler));
}

void Transport::Publish(const std::string& channel, const uint8_t* data, size_t size) {
  if (lcm_.publish(channel, data, static_cast<unsigned>(size)) != 0) {
    throw std::runtime_error(url_ + ": publishing " + std::to_string(size) + " bytes on " +
                             channel + " failed");
  }
}

}  // namespace hairpin
