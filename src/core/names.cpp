#include <sunfleck/core/names.hpp>

#include <algorithm>
#include <cctype>
#include <vector>

namespace sunfleck {

namespace {
char lower(char c) {
  return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
}
}  // namespace

int edit_distance(std::string_view a, std::string_view b) {
  const std::size_t n = b.size() + 1;
  std::vector<int> before_last(n), last(n), row(n);
  for (std::size_t j = 0; j < n; ++j) row[j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before_last.swap(last);
    last.swap(row);
    row[0] = static_cast<int>(i);
    for (std::size_t j = 1; j < n; ++j) {
      const char x = lower(a[i - 1]), y = lower(b[j - 1]);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (x != y)});
      if (i > 1 && j > 1 && x == lower(b[j - 2]) && lower(a[i - 2]) == y) row[j] = std::min(row[j], before_last[j - 2] + 1);
    }
  }
  return row.back();
}

std::string nearest_name(std::string_view found, std::span<const std::string> known) {
  const int limit = std::max(2, static_cast<int>(found.size() / 3));
  int best = limit + 1;
  std::string name;
  for (const auto& k : known) {
    const int d = edit_distance(found, k);
    if (d < best) {
      best = d;
      name = k;
    }
  }
  return name;
}

std::vector<std::string> distinct_names(std::span<const std::string> names, const std::function<std::string(const std::string&)>& clean,
                                        const std::set<std::string>& taken) {
  std::vector<std::string> out(names.size());
  std::set<std::string> used;
  std::vector<std::size_t> changed;
  for (std::size_t i = 0; i < names.size(); ++i) {
    out[i] = clean(names[i]);
    if (out[i] != names[i] || !used.insert(out[i]).second) changed.push_back(i);
  }
  for (const auto i : changed) {
    const std::string name = out[i];
    for (int k = 2; taken.count(out[i]) > 0 || !used.insert(out[i]).second; ++k) out[i] = name + "_" + std::to_string(k);
  }
  return out;
}

std::string joined(std::span<const std::string> names) {
  std::string text;
  for (const auto& n : names) text += (text.empty() ? "" : ", ") + n;
  return text;
}

}  // namespace sunfleck
