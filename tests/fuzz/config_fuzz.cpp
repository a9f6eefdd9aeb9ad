#include "app/config_file.h"
#include "control/selector_rules.h"
#include "fuzz_input.h"

int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string_view text = eye::fuzz::textOf(data, size);
  (void)eye::parseConfig(text, "config.toml");
  (void)eye::parseSelectorRules(text, "selector.toml");
  return 0;
}
