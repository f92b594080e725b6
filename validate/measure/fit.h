// Numbers from curves: least squares, orders, periods.
#pragma once
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "dreampm/base/error.h"

namespace dreampm::validate {

/// The slope of the least-squares line through (x, y). At least two points.
inline double slope_of(const std::vector<double>& x, const std::vector<double>& y) {
  if (x.size() != y.size() || x.size() < 2) throw std::invalid_argument("a slope needs two points or more");
  double mx = 0, my = 0, xy = 0, xx = 0;
  const double n = static_cast<double>(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) mx += x[i] / n, my += y[i] / n;
  for (std::size_t i = 0; i < x.size(); ++i) xy += (x[i] - mx) * (y[i] - my), xx += (x[i] - mx) * (x[i] - mx);
  return xy / xx;
}

/// The mean over draws, and its standard error; 0 without chance.
struct Mean {
  double mean = 0, uncertainty = 0;

  /// No error is known better than its standard error.
  double known() const { return std::copysign(std::max(std::abs(mean), uncertainty), mean); }
};

/// Returns the mean of at least one draw; of one alone nothing is known of the chance in it.
inline Mean mean_of(const std::vector<double>& draws) {
  if (draws.empty()) throw std::invalid_argument("no draws have no mean");
  const double n = static_cast<double>(draws.size());
  double mean = 0, squares = 0;
  for (const double x : draws) mean += x / n;
  for (const double x : draws) squares += (x - mean) * (x - mean);
  return {mean, n > 1 ? std::sqrt(squares / (n * (n - 1))) : 0};
}

/// The order p of errors e ~ h^p at cells a side n = 1/h, by least squares in logarithms.
inline double order_of(const std::vector<double>& cells, const std::vector<double>& errors) {
  std::vector<double> x, y;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    x.push_back(-std::log(cells[i]));
    y.push_back(std::log(std::abs(errors[i])));
  }
  return slope_of(x, y);
}

/// y at `at` of the piecewise linear curve through (x, y), x ascending; the ends' values beyond
/// them.
inline double interpolate(const std::vector<double>& x, const std::vector<double>& y, double at) {
  if (x.empty()) throw std::invalid_argument("an empty curve has no value");
  const auto above = std::upper_bound(x.begin(), x.end(), at);
  if (above == x.begin()) return y.front();
  if (above == x.end()) return y.back();
  const auto i = static_cast<std::size_t>(above - x.begin());
  return y[i - 1] + (y[i] - y[i - 1]) * (at - x[i - 1]) / (x[i] - x[i - 1]);
}

/// A swinging quantity, sample by sample: its zeros give the period, its extremes between them the
/// amplitude.
class Swing {
 public:
  void add(double time, double q) {
    if (before_ != 0 && (q > 0) != (before_ > 0)) {
      zeros_.push_back(time_before_ + (time - time_before_) * before_ / (before_ - q));
      extremes_.push_back(0);
    }
    if (!extremes_.empty()) extremes_.back() = std::max(extremes_.back(), std::abs(q));
    before_ = q, time_before_ = time;
    times.push_back(time), values.push_back(q);
  }
  /// Returns the period from the first zero to the last. At least two zeros.
  double period() const {
    if (zeros_.size() < 2) throw RunError("it does not swing: fewer than two zeros, so no period");
    return 2 * (zeros_.back() - zeros_.front()) / static_cast<double>(zeros_.size() - 1);
  }
  std::size_t zeros() const { return zeros_.size(); }
  /// The largest |q| after the n-th zero, before the next.
  double extreme(std::size_t n) const { return extremes_.at(n); }
  std::vector<double> times, values;

 private:
  double before_ = 0, time_before_ = 0;
  std::vector<double> zeros_, extremes_;
};

}  // namespace dreampm::validate
