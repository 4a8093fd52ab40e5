#include <catch2/catch.hpp>

#include <sunfleck/plant/leaf_type.hpp>

using namespace sunfleck;

TEST_CASE("a leaf is a leaf in any case of letters", "[plant]") {
  for (const char* leaf : {"leaf", "Leaf", "LEAF", "lEaF"}) CHECK(is_leaf_type(leaf));
  for (const char* other : {"", "lea", "leaflet", "leaf ", "blade", "stem"}) CHECK_FALSE(is_leaf_type(other));
}
