// Organs of a result in ranges of rows, for tables.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <sunfleck/result/result_reader.hpp>

#include "view/column_names.hpp"

namespace sunfleck {

/// What the file keeps of light on organs, or on facets.
struct KeptValues {
  bool absorbed = false, irradiance = false, sunlit = false;
  bool sums = false;  ///< absorbed is kept and every state has a duration
};
/// `rows` is "organs" or "facets". Throws InputError where the file keeps none of them.
KeptValues kept_values(const Result& result, const std::string& rows);

/// String tables that organs name rows of.
struct OrganTexts {
  explicit OrganTexts(const Result& result);
  std::vector<std::string> names, types, plants, placements;
};

/// Rows [first, first + count) of /organs. Checked: rows of names are below their numbers.
struct OrganBlock {
  OrganBlock(const Result& result, const OrganTexts& names, std::size_t first, std::size_t count);
  std::size_t first, count;
  std::vector<std::uint32_t> name, type, plant, placement, structure;
};

/// Light of a range of organs or facets in one state; empty where the file does not keep it.
struct LightBlock {
  LightBlock(const Result& result, const std::string& rows, const KeptValues& kept, std::size_t state, std::size_t first,
             std::size_t count);
  std::vector<float> absorbed, irradiance, sunlit;
};

/// True for bands that count photons.
bool counts_photons(const std::string& unit);

/// Quoted where RFC 4180 wants it.
std::string csv_field(const std::string& text);

/// "absorbed_W_PAR", "irradiance_front_PAR", ...: per state and band, then sums over the states. No two are alike.
std::vector<std::string> value_names(const Result& result, const KeptValues& kept, ColumnNames::Clean clean = same_name);
/// A header line: `first` and then value_names, none twice.
std::string header_line(std::vector<std::string> first, const Result& result, const KeptValues& kept);

}  // namespace sunfleck
