#include "validate/suite.h"

#include <algorithm>
#include <exception>
#include <mutex>
#include <numeric>
#include <optional>
#include <thread>

#include "dreampm/base/log.h"
#include "dreampm/base/parallel.h"
#include "validate/validation_run.h"

namespace dreampm::validate {
namespace {

/// The state that the threads share: the number of the next case, and the results of the finished
/// ones.
class Suite {
 public:
  Suite(std::span<const Case* const> cases, Level level, const std::function<void(const Result&)>& done)
      : cases_(cases), done_(done), results_(cases.size()), errors_(cases.size()), order_(cases.size()) {
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::stable_sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) {
      return cases_[a]->seconds_at(level) > cases_[b]->seconds_at(level);
    });
  }

  /// Takes cases and runs them until none is left.
  template <class Run>
  void work(const Run& run) {
    while (const auto i = take()) {
      std::optional<Result> result;
      std::exception_ptr error;
      try {
        result = run(*cases_[*i]);
      } catch (...) {
        error = std::current_exception();
      }
      finish(*i, std::move(result), error);
    }
  }

  /// Returns the results after all work. Results behind a case that was not done were not reported
  /// yet.
  std::vector<Result> results() {
    for (; reported_ < cases_.size(); ++reported_)
      if (results_[reported_]) done_(*results_[reported_]);
    std::vector<Result> all;
    for (auto& result : results_)
      if (result) all.push_back(std::move(*result));
    for (const auto& e : errors_) {
      if (!e) continue;
      try {
        std::rethrow_exception(e);
      } catch (const Interrupted&) {  // seen by how few results there are
      }
    }
    return all;
  }

 private:
  std::optional<std::size_t> take() {
    const std::scoped_lock lock(mutex_);
    if (stop_ || next_ == order_.size()) return std::nullopt;
    return order_[next_++];
  }
  void finish(std::size_t i, std::optional<Result> result, const std::exception_ptr& error) {
    const std::scoped_lock lock(mutex_);
    results_[i] = std::move(result);
    errors_[i] = error;
    if (error) stop_ = true;
    for (; reported_ < cases_.size() && results_[reported_]; ++reported_) done_(*results_[reported_]);
    if (results_[i]) log_info(fmt::format("{} of {} cases ran: {}", ++finished_, cases_.size(), cases_[i]->name));
  }

  std::span<const Case* const> cases_;
  const std::function<void(const Result&)>& done_;
  std::mutex mutex_;
  std::vector<std::optional<Result>> results_;
  std::vector<std::exception_ptr> errors_;
  std::vector<std::size_t> order_;
  std::size_t next_ = 0, reported_ = 0, finished_ = 0;
  bool stop_ = false;
};

}  // namespace

void check_backend(const Options& options) { float_backend(options); }

std::vector<Result> run_cases(std::span<const Case* const> cases, const Options& options,
                              const std::filesystem::path& folder, const std::function<void(const Result&)>& done) {
  Suite suite(cases, options.level, done);
  const std::size_t workers = std::min(cases.size(), static_cast<std::size_t>(std::max(1, thread_count())));
  if (workers <= 1) {
    suite.work([&](const Case& c) { return run_case(c, options, folder, Clock::process); });
  } else {
    std::vector<std::thread> threads;
    for (std::size_t i = 0; i < workers; ++i)
      threads.emplace_back([&] {
        on_this_thread([&] { suite.work([&](const Case& c) { return run_case(c, options, folder, Clock::thread); }); });
      });
    for (std::thread& t : threads) t.join();
  }
  return suite.results();
}

}  // namespace dreampm::validate
