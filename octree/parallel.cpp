#include "octree/parallel.h"
#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <omp.h>
#include <system_error>
#include <thread>
#include <vector>

namespace pointgi {

namespace {

thread_local void (*ask_before_range)() = nullptr;

} // namespace

void before_ranges(void (*ask)()) {
  ask_before_range = ask;
}

void ask_now() {
  if (ask_before_range != nullptr) ask_before_range();
}

namespace detail {

namespace {

thread_local bool inside_loop = false; ///< this thread runs a range just now

/// A loop, and who takes part in it.
struct Loop {
  std::size_t ranges;
  void (*call)(const void*, std::size_t);
  const void* body;
  std::atomic<std::size_t> next{0}; ///< the next range that nobody has taken
  unsigned seats;                   ///< how many more workers may join
  unsigned working = 0;
  std::exception_ptr failure;

  /// Takes ranges until there are none left, or until `ask` throws.
  std::exception_ptr work(void (*ask)()) {
    std::exception_ptr thrown;
    inside_loop = true;
    for (std::size_t range; (range = next++) < ranges;) {
      try {
        if (ask != nullptr) ask();
      } catch (...) {
        next = ranges;
        thrown = std::current_exception();
        break;
      }
      try {
        call(body, range);
      } catch (...) {
        thrown = thrown ? thrown : std::current_exception();
      }
    }
    inside_loop = false;
    return thrown;
  }
};

/// Threads that sleep between loops. The caller waits only for those that have joined its loop: at the barrier of an
/// OpenMP loop it would wait for every thread to be given a core, and where other programs keep the cores busy that
/// made building an octree of 50,000 splats, some 20 loops, tens of times slower.
class Workers {
public:
  ~Workers() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      ending_ = true;
    }
    wake_.notify_all();
    for (std::thread& thread : threads_)
      thread.join();
  }

  void run(Loop& loop) {
    std::unique_lock<std::mutex> lock(mutex_);
    try {
      while (threads_.size() < loop.seats)
        threads_.emplace_back([this] { serve(); });
    } catch (const std::system_error&) { // no more to be had: those that are there do it
    }
    loop_ = &loop;
    lock.unlock();
    wake_.notify_all();
    std::exception_ptr thrown = loop.work(ask_before_range);
    lock.lock();
    loop_ = nullptr; // who comes now comes too late
    left_.wait(lock, [&] { return loop.working == 0; });
    if (!loop.failure) loop.failure = thrown;
  }

  std::mutex turn; ///< held by the caller whose loop runs

private:
  void serve() {
    std::unique_lock<std::mutex> lock(mutex_);
    while (true) {
      wake_.wait(lock, [&] { return ending_ || (loop_ != nullptr && loop_->seats > 0); });
      if (ending_) return;
      Loop& loop = *loop_;
      --loop.seats;
      ++loop.working;
      lock.unlock();
      const std::exception_ptr thrown = loop.work(nullptr);
      lock.lock();
      if (!loop.failure) loop.failure = thrown;
      if (--loop.working == 0) left_.notify_one();
    }
  }

  std::mutex mutex_; ///< guards all below, and a loop's seats, working and failure
  std::condition_variable wake_, left_;
  std::vector<std::thread> threads_;
  Loop* loop_ = nullptr;
  bool ending_ = false;
};

} // namespace

void run_ranges(std::size_t ranges, void (*call)(const void*, std::size_t), const void* body) {
  static Workers workers;
  const auto threads = static_cast<std::size_t>(std::max(1, omp_get_max_threads()));
  std::unique_lock<std::mutex> turn(workers.turn, std::defer_lock);
  const bool alone = inside_loop || threads == 1 || ranges < 2 || !turn.try_lock();
  if (alone) {
    for (std::size_t range = 0; range < ranges; ++range) {
      if (ask_before_range != nullptr) ask_before_range();
      call(body, range);
    }
    return;
  }
  Loop loop{ranges, call, body, {}, static_cast<unsigned>(std::min(threads, ranges) - 1), 0, nullptr};
  workers.run(loop);
  if (loop.failure) std::rethrow_exception(loop.failure);
}

} // namespace detail

} // namespace pointgi
