#include "view/viewer_service.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#define STBI_WRITE_NO_STDIO
#include <stb_image_write.h>

#include <fmt/format.h>

#include <sunfleck/core/error.hpp>

#include "view/viewer_answers.hpp"
#include "view/web_files.hpp"

namespace sunfleck {

namespace {

constexpr std::size_t clients_kept = 64;
constexpr std::size_t most_rows = 200;  ///< of a list

Answer json_answer(const nlohmann::json& content, int status = 200) {
  // Names come from files: what is no UTF-8 is replaced rather than refused.
  return {status, "application/json", content.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)};
}

Answer problem_answer(int status, const std::string& text) {
  return json_answer({{"error", text}}, status);
}

std::string encoded(const Image& image, bool png, int quality) {
  std::string bytes;
  const auto append = [](void* context, void* data, int size) {
    static_cast<std::string*>(context)->append(static_cast<char*>(data), static_cast<std::size_t>(size));
  };
  if (png)
    stbi_write_png_to_func(append, &bytes, image.width(), image.height(), 3, image.data(), image.width() * 3);
  else
    stbi_write_jpg_to_func(append, &bytes, image.width(), image.height(), 3, image.data(), quality);
  if (bytes.empty()) throw Error("the picture could not be encoded");
  return bytes;
}

Answer file_answer(const WebFile& file) {
  return {200, std::string(file.type), std::string(file.content)};
}

}  // namespace

void ViewerService::load() {
  ViewerScenes loaded;
  for (const auto& file : files_) loaded.push_back(std::make_shared<const ViewerScene>(file, stopping_));
  if (loaded.size() == 2) loaded[0]->match(*loaded[1]);  // now, not when the page first asks
  const std::lock_guard lock(mutex_);
  scenes_ = std::move(loaded);
  ++generation_;
}

bool ViewerService::reload(std::string& problem) {
  const std::lock_guard one_at_a_time(reloading_);
  ViewerScenes now = scenes();
  bool changed = false;
  try {
    for (auto& scene : now) {
      if (const auto stamp = file_stamp(scene->file()); stamp == scene->stamp()) continue;
      scene = std::make_shared<const ViewerScene>(scene->file(), stopping_);
      changed = true;
    }
  } catch (const std::exception& error) {
    problem = error.what();
    return false;
  }
  if (!changed) return true;
  const std::lock_guard lock(mutex_);
  scenes_ = std::move(now);
  ++generation_;
  return true;
}

ViewerScenes ViewerService::scenes() const {
  const std::lock_guard lock(mutex_);
  return scenes_;
}

Answer ViewerService::status() const {
  const ViewerScenes open = scenes();
  nlohmann::json out{{"ready", !open.empty()}, {"changed", nlohmann::json::array()}};
  bool exact = !open.empty();
  for (const auto& scene : open) {
    exact = exact && scene->exact();
    if (const auto stamp = file_stamp(scene->file()); stamp != scene->stamp())
      out["changed"].push_back({{"file", scene->file()}, {"missing", !stamp.has_value()}});
  }
  out["exact"] = exact;
  const std::lock_guard lock(mutex_);
  out["generation"] = generation_;
  return json_answer(out);
}

std::function<bool()> ViewerService::turn_over(const Parameters& parameters) {
  const auto name = parameters("client");
  const std::uint64_t turn = read_count(parameters, "turn", 0, 0, std::size_t{1} << 53);
  if (!name) return [this] { return stopping_.cancelled(); };
  if (name->size() > 64) throw UsageError("client: found a long name; expected at most 64 letters");
  std::shared_ptr<std::atomic<std::uint64_t>> latest;
  {
    const std::lock_guard lock(mutex_);
    const auto known = std::find_if(clients_.begin(), clients_.end(), [&](const Client& c) { return c.name == *name; });
    if (known == clients_.end()) {
      clients_.push_front({*name, std::make_shared<std::atomic<std::uint64_t>>(0)});
      if (clients_.size() > clients_kept) clients_.pop_back();
    } else {
      clients_.splice(clients_.begin(), clients_, known);
    }
    latest = clients_.front().turn;
  }
  for (std::uint64_t seen = *latest; seen < turn && !latest->compare_exchange_weak(seen, turn);) {
  }
  return [this, latest, turn] { return *latest > turn || stopping_.cancelled(); };
}

Answer ViewerService::frame(const ViewerScenes& open, const Parameters& parameters) {
  const auto cancelled = turn_over(parameters);
  const ViewerView view = read_view(parameters, open);
  const bool quick = read_flag(parameters, "quick", false);
  const auto time = std::chrono::milliseconds(read_count(parameters, "time", 120, 0, 2000));
  const bool png = parameters("format").value_or("jpeg") == "png";
  const auto begin = std::chrono::steady_clock::now();
  const ShownFrame shown = quick ? frames_.quick(open, view, cancelled) : frames_.refined(open, view, time, cancelled);
  const double traced = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  Answer out{200, png ? "image/png" : "image/jpeg", encoded(shown.image, png, quick ? 82 : 93)};
  out.headers = {{"X-Samples", fmt::format("{:.4f}", shown.samples)},
                 {"X-Done", shown.done ? "1" : "0"},
                 {"X-Draft", shown.draft ? "1" : "0"},
                 {"X-Milliseconds", fmt::format("{:.1f}", traced)}};
  return out;
}

Answer ViewerService::table(const std::string& path, const ViewerScenes& open, const Parameters& parameters) const {
  const std::size_t result = read_count(parameters, "result", 0, 0, open.size() - 1);
  const ShownQuantity shown = read_quantity(parameters, open, result);
  const auto statistics = selection_statistics(open, shown.difference ? 0 : result, shown, parameters("select").value_or(""),
                                               read_count(parameters, "bins", 40, 1, 1000), read_count(parameters, "layers", 20, 1, 1000));
  if (path == "/api/statistics") return json_answer(statistics_json(statistics));
  const bool profile = path == "/api/profile.csv";
  Answer out{200, "text/csv; charset=utf-8", profile ? profile_csv(statistics) : histogram_csv(statistics)};
  out.headers = {{"Content-Disposition", fmt::format("attachment; filename=\"{}.csv\"", profile ? "profile" : "histogram")}};
  return out;
}

Answer ViewerService::answer(bool post, const std::string& path, const Parameters& parameters) {
  try {
    if (path == "/api/reload") {
      if (!post) return problem_answer(405, "POST is expected");
      std::string problem;
      return reload(problem) ? status() : problem_answer(409, problem);
    }
    if (post) return problem_answer(405, "GET is expected");
    if (const WebFile* file = web_file(path == "/" ? "index.html" : std::string_view(path).substr(1))) return file_answer(*file);
    if (path == "/api/status") return status();
    if (!path.starts_with("/api/")) return problem_answer(404, "nothing of that name");
    const ViewerScenes open = scenes();
    if (open.empty()) return problem_answer(503, "the result is still being read");
    const ViewerScene& scene = *open[read_count(parameters, "result", 0, 0, open.size() - 1)];
    if (path == "/api/describe") return json_answer(describe(open));
    if (path == "/api/frame") return frame(open, parameters);
    if (path == "/api/legend") return json_answer(legend(open, read_view(parameters, open)));
    if (path == "/api/pick") {
      const ViewerView view = read_view(parameters, open);
      return json_answer(pick(open, view, read_number(parameters, "x", 0.5, 0, 1), read_number(parameters, "y", 0.5, 0, 1)));
    }
    if (path == "/api/organ") {
      const auto organ = read_count(parameters, "organ", 0, 0, scene.scene().organs.size() - 1);
      return json_answer(organ_numbers(scene, organ, no_facet, read_count(parameters, "state", 0, 0, scene.states().size() - 1)));
    }
    if (path == "/api/search") return json_answer(search_organs(scene, parameters("text").value_or(""), most_rows));
    if (path == "/api/placements") return json_answer(placements(scene, parameters("text").value_or(""), most_rows));
    if (path == "/api/statistics" || path == "/api/histogram.csv" || path == "/api/profile.csv") return table(path, open, parameters);
    return problem_answer(404, "nothing of that name");
  } catch (const UsageError& error) {
    return problem_answer(400, error.what());
  } catch (const InputError& error) {  // the file was damaged underneath
    return problem_answer(409, error.what());
  } catch (const std::bad_alloc&) {
    return problem_answer(500, "not enough memory");
  } catch (const std::exception& error) {
    return problem_answer(500, error.what());
  }
}

}  // namespace sunfleck
