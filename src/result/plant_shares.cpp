#include <sunfleck/result/plant_shares.hpp>

#include <string>

#include <sunfleck/core/error.hpp>
#include <sunfleck/result/result_reader.hpp>

namespace sunfleck {

std::optional<PlantShares> plant_shares(const Result& result) {
  if (!result.has("balance/plants/name")) return std::nullopt;
  PlantShares out(result.states().size(), result.bands().size(), result.strings("balance/plants/name"));
  const auto column = [&](const char* name) {
    auto values = result.all<double>(name);
    if (values.size() != out.leaf.size())
      throw InputError(location(result.file(), 0, std::string("/") + name), std::to_string(values.size()) + " values",
                       std::to_string(out.leaf.size()));
    return values;
  };
  out.leaf = column("balance/plants/leaf");
  out.other = column("balance/plants/other");
  return out;
}

}  // namespace sunfleck
