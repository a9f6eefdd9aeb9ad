#include <catch2/catch.hpp>

#include "base/nearest_word.h"

using namespace eye;

TEST_CASE("a slip of the keyboard finds the word that was meant") {
  CHECK(nearestWord("cache-rm", {"cache-ram", "cache-gpu", "size"}) == "cache-ram");
  CHECK(nearestWord("zzzzzzzz", {"cache-ram", "size"}).empty());
}
