// Rows of opened copies, in the order of the file.
#pragma once

#include <map>
#include <vector>

#include <sunfleck/core/memory.hpp>
#include <sunfleck/scene/solution.hpp>

namespace sunfleck {

/// Rows of one copy, as the sink takes them; none for a copy that is solved together with one that is opened.
struct CopyRows {
  std::size_t first = 0, count = 0;
  std::vector<float> irradiance, sunlit;  ///< as IrradianceRows; sunlit is empty without sun
  std::size_t bytes() const { return bytes_of(irradiance) + bytes_of(sunlit); }
};

/// Copies are opened original by original; their rows wait until those before them have been sent.
class RowsInOrder {
 public:
  explicit RowsInOrder(IrradianceSink& sink) : sink_(sink) {}

  void send(std::vector<CopyRows>& rows) {
    for (auto& r : rows)
      if (r.count > 0) waiting_.emplace(r.first, std::move(r));
    while (!waiting_.empty() && waiting_.begin()->first == next_) {
      const CopyRows& r = waiting_.begin()->second;
      sink_.rows({r.first, r.count, r.irradiance.data(), r.sunlit.empty() ? nullptr : r.sunlit.data(), nullptr});
      next_ += r.count;
      waiting_.erase(waiting_.begin());
    }
  }
  /// Of those that wait.
  std::size_t bytes() const {
    std::size_t total = 0;
    for (const auto& [first, r] : waiting_) total += r.bytes();
    return total;
  }

 private:
  IrradianceSink& sink_;
  std::map<std::size_t, CopyRows> waiting_;
  std::size_t next_ = 0;
};

}  // namespace sunfleck
