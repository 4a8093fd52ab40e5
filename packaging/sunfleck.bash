# Completion of sunfleck for bash: verbs, the options that a verb's --help lists, their choices, and files.
_sunfleck() {
  local word=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]} verb="" at help
  for ((at = 1; at < COMP_CWORD; ++at)); do
    case ${COMP_WORDS[at]} in -*) ;; *) verb=${COMP_WORDS[at]}; break ;; esac
  done
  COMPREPLY=()
  if [ -z "$verb" ]; then
    help=$("${COMP_WORDS[0]}" --help 2>/dev/null)
    mapfile -t COMPREPLY < <(compgen -W "--help --version $(sed -nE '/^Verbs:/,$s/^  ([a-z][a-z-]+) .*/\1/p' <<<"$help")" -- "$word")
    return
  fi
  help=$("${COMP_WORDS[0]}" "$verb" --help 2>/dev/null)
  case $previous in
    --quality) mapfile -t COMPREPLY < <(compgen -W "draft standard fine" -- "$word"); return ;;
    --method) mapfile -t COMPREPLY < <(compgen -W "instantiation clustering flat direct reference" -- "$word"); return ;;
  esac
  if [[ $word == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$(grep -oE '(^|[ ,])--?[a-z][a-z-]*' <<<"$help" | tr -d ' ,' | sort -u)" -- "$word")
  else
    mapfile -t COMPREPLY < <(compgen -f -- "$word")
  fi
}
complete -o filenames -F _sunfleck sunfleck
