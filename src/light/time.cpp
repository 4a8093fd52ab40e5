#include <sunfleck/light/time.hpp>

#include <charconv>
#include <cstdint>

#include <sunfleck/core/error.hpp>

namespace sunfleck {

namespace {

/// Reads fixed-width fields; any mismatch makes it bad for good.
class Fields {
 public:
  explicit Fields(const std::string& text) : text_(text) {}
  int number(std::size_t digits) {
    int value = 0;
    for (std::size_t i = 0; i < digits; ++i, ++at_) {
      if (at_ >= text_.size() || text_[at_] < '0' || text_[at_] > '9') return good_ = false, 0;
      value = 10 * value + (text_[at_] - '0');
    }
    return value;
  }
  bool next_is(char c) const { return at_ < text_.size() && text_[at_] == c; }
  bool take(char c) { return next_is(c) && ++at_; }
  void need(char c) { good_ = take(c) && good_; }
  double fraction() {
    double value = 0, unit = 0.1;
    const auto first = at_;
    for (; at_ < text_.size() && text_[at_] >= '0' && text_[at_] <= '9'; ++at_, unit *= 0.1) value += unit * (text_[at_] - '0');
    good_ = at_ > first && good_;
    return value;
  }
  void fail() { good_ = false; }
  bool ended_well() const { return good_ && at_ == text_.size(); }

 private:
  const std::string& text_;
  std::size_t at_ = 0;
  bool good_ = true;
};

bool is_leap(int year) {
  return (year % 4 == 0 && year % 100 != 0) || year % 400 == 0;
}
int days_in(int month, int year) {
  constexpr int days[] = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
  return month == 2 && is_leap(year) ? 29 : days[month - 1];
}

}  // namespace

Moment parse_time(const std::string& iso_time, const std::string& where) {
  Fields in(iso_time);
  const int year = in.number(4);
  in.need('-');
  const int month = in.number(2);
  in.need('-');
  const int day = in.number(2);
  in.need('T');
  const int hour = in.number(2);
  in.need(':');
  const int minute = in.number(2);
  double second = 0;
  if (in.take(':')) {
    second = in.number(2);
    if (in.take('.')) second += in.fraction();
  }
  int zone_minutes = 0, zone_minute = 0;
  if (!in.take('Z')) {
    const int sign = in.next_is('-') ? -1 : 1;
    if (!in.take('+') && !in.take('-')) in.fail();
    const int zone_hour = in.number(2);
    in.need(':');
    zone_minute = in.number(2);
    zone_minutes = sign * (60 * zone_hour + zone_minute);
  }
  const bool exists = month >= 1 && month <= 12 && day >= 1 && day <= days_in(month, year) && hour <= 23 && minute <= 59 && second < 60.0 &&
                      zone_minute <= 59 && zone_minutes >= -24 * 60 && zone_minutes <= 24 * 60;
  if (!in.ended_well() || !exists)
    throw InputError(where, "\"" + iso_time + "\"",
                     "a time that exists, in ISO 8601 with its zone, such as \"2026-06-21T09:00:00+02:00\" or \"2026-06-21T07:00:00Z\"");

  int day_of_year = day;
  for (int m = 1; m < month; ++m) day_of_year += days_in(m, year);
  const std::int64_t past = year - 1;  // whole years; year 0 comes out right because the divisions below round down
  const auto floor_div = [](std::int64_t a, std::int64_t b) { return (a >= 0 ? a : a - b + 1) / b; };
  const std::int64_t days =
      365 * past + floor_div(past, 4) - floor_div(past, 100) + floor_div(past, 400) + day_of_year;  // 1 January of year 1 is 1
  constexpr double julian_date_of_day_zero = 1721424.5;
  const double day_fraction = (3600.0 * hour + 60.0 * (minute - zone_minutes) + second) / 86400.0;
  return {julian_date_of_day_zero + static_cast<double>(days) + day_fraction, day_of_year};
}

}  // namespace sunfleck
