# Bash completion for Eyepoint's programs: options and their words from --help, so that it never lags behind; else files.
_eyepoint() {
  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]} program=${COMP_WORDS[0]} help words line
  local subcommand=
  [[ $COMP_CWORD -gt 1 && ${COMP_WORDS[1]} != -* && $program == *-bake ]] && subcommand=${COMP_WORDS[1]}
  [[ $COMP_CWORD -gt 1 && ${COMP_WORDS[1]} =~ ^(compare|plots)$ && $program == *-bench ]] && subcommand=${COMP_WORDS[1]}
  # shellcheck disable=SC2086  # without a subcommand there is no such word
  help=$("$program" $subcommand --help 2>/dev/null) || return
  COMPREPLY=()
  if [[ $previous == --* && $previous != *=* ]]; then
    # "--culling none/frustum/dynamic", "--log-level TEXT:{debug,info}": words in small letters are what may follow.
    line=$(grep -oE -- "(^|[ ,])$previous [^ ]+" <<<"$help" | head -n 1)
    words=$(sed -E 's/.*\{(.*)\}.*/\1/; s/:.*//' <<<"${line##* }" | tr '/,' '\n' | grep -E '^[a-z][a-z-]*$')
    [ -n "$words" ] && mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")
  elif [[ $current == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$(grep -oE -- '(^|[ ,])--[a-z][a-z-]+' <<<"$help" | tr -d ' ,' | sort -u)" -- "$current")
  elif [[ $COMP_CWORD -eq 1 ]]; then
    words=$(sed -n '/^\(Subcommands\|Suites\):/,/^[^ ]*$/s/^  \([a-z][a-z-]*\) .*/\1/p' <<<"$help")
    [ -n "$words" ] && mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")
  fi
  [[ ${#COMPREPLY[@]} -gt 0 ]] || mapfile -t COMPREPLY < <(compgen -f -- "$current")
}
complete -o filenames -F _eyepoint eyepoint eyepoint-bake eyepoint-bench eyepoint-host eyepoint-panorama
