// Room for work that one thread needs at a time, made once and lent again.
#pragma once

#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace gaussmap {

/// As many of a kind as were ever needed at once. Which one is lent does not depend on who asks: results must not
/// depend on what the last borrower left.
template <class T>
class Pool {
  public:
    std::unique_ptr<T> take() {
        const std::lock_guard<std::mutex> lock(mutex_);
        if (idle_.empty()) return std::make_unique<T>();
        std::unique_ptr<T> one = std::move(idle_.back());
        idle_.pop_back();
        return one;
    }
    void give_back(std::unique_ptr<T> one) {
        const std::lock_guard<std::mutex> lock(mutex_);
        idle_.push_back(std::move(one));
    }

  private:
    std::mutex mutex_;
    std::vector<std::unique_ptr<T>> idle_;
};

}  // namespace gaussmap
