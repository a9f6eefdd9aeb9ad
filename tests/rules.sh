#!/usr/bin/env bash
# Rules of the house that no compiler knows. Prints every breach; exit 1 where there is one.
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.." || exit
breaches=0

# breach WHAT LINES: complains where LINES is not empty.
breach() {
  [ -z "$2" ] && return
  printf 'rules: %s\n%s\n' "$1" "$2" >&2
  breaches=1
}

breach "a device wait belongs to shutdown and resize alone, and says which in a comment on its line" \
  "$(grep -rnE '[wW]aitIdle *\(' src tools --include='*.cpp' --include='*.h' | grep -vE '// .*(shutdown|resize)')"

breach "the core knows neither Vulkan nor GDAL nor a window" \
  "$(grep -rnE '#include *[<"](vulkan|gdal|GLFW|ogr_|cpl_|imgui)' src/base src/telemetry src/geo src/terrain src/paging src/link src/control src/predict)"

breach "a file is at most 700 lines" \
  "$(find src tools tests shaders -type f \( -name '*.cpp' -o -name '*.h' -o -name '*.vert' -o -name '*.frag' -o -name '*.comp' \) -exec wc -l {} + |
    awk '$1 > 700 && $2 != "total" { print $2 ": " $1 }')"

breach "work left open does not stand in the code" \
  "$(grep -rnE '\b(TODO|FIXME|XXX|HACK)\b' src tools tests shaders --include='*.cpp' --include='*.h' --include='*.vert' --include='*.frag')"

breach "a header says first what it is for, and is read once" \
  "$(find src tools tests -name '*.h' | while read -r header; do
    head -n 1 "$header" | grep -q '^//' && grep -q '^#pragma once\|^#ifndef EYE_' "$header" || echo "$header"
  done)"

exit "$breaches"
