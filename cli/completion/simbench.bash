# bash completion for simbench; made by `simbench completion bash`.

_simbench_commands='{{commands}}'

{{cases}}
# Those of the folders that hold results, or hold a folder that does; all if none does.
_simbench_archives() {
  local folder
  local -a all=() found=()
  while IFS= read -r folder; do
    all+=("$folder")
    if [[ -e $folder/results.json ]] || compgen -G "$folder/*/results.json" > /dev/null; then
      found+=("$folder")
    fi
  done
  (( ${#found[@]} )) || found=("${all[@]}")
  (( ${#found[@]} == 0 )) || printf '%s\n' "${found[@]}"
}

# The candidates of a kind of value for the word being typed: KIND WORD PROGRAM SCENARIO.
_simbench_complete() {
  local word=$2 before=
  case $1 in
    word\ *) mapfile -t COMPREPLY < <(compgen -W "${1#word }" -- "$word") ;;
    folder) compopt -o filenames; mapfile -t COMPREPLY < <(compgen -d -- "$word") ;;
    file) compopt -o filenames; mapfile -t COMPREPLY < <(compgen -f -- "$word") ;;
    command) mapfile -t COMPREPLY < <(compgen -W "$_simbench_commands" -- "$word") ;;
    figure)
      mapfile -t COMPREPLY < <(
        compgen -W "$("$3" list figures --format names 2> /dev/null)" -- "$word")
      ;;
    archive)
      compopt -o filenames
      mapfile -t COMPREPLY < <(
        compgen -d -- "$word" | _simbench_archives
        compgen -f -X '!*.json' -- "$word"
      )
      ;;
    pipelines)
      [[ -n $4 ]] || return
      [[ $word != *,* ]] || before=${word%,*},
      mapfile -t COMPREPLY < <(
        compgen -P "$before" -W \
          "$("$3" list pipelines --scenario "$4" --format names 2> /dev/null)" -- "${word##*,}")
      ;;
    pointer)
      [[ -n $4 ]] || return
      compopt -o nospace
      mapfile -t COMPREPLY < <(
        compgen -S = -W "$("$3" describe "$4" --format names 2> /dev/null)" -- "$word")
      ;;
    start)
      mapfile -t COMPREPLY < <(compgen -W "$_simbench_commands" -- "$word")
      [[ -z $word || ${#COMPREPLY[@]} -gt 0 ]] || _simbench_complete scenario "$word" "$3"
      ;;
    scenario)
      compopt -o filenames
      mapfile -t COMPREPLY < <(
        compgen -W "$("$3" list scenarios --format names 2> /dev/null)" -- "$word"
        compgen -f -- "$word"
      )
      ;;
  esac
}

_simbench() {
  local program=${COMP_WORDS[0]} word=${COMP_WORDS[COMP_CWORD]} at=1 command option='' place=0 kind
  local scenario=
  local -a words=()
  COMPREPLY=()
  # bash breaks words at "=": --format=json is three of them.
  while (( at < COMP_CWORD )); do
    [[ ${COMP_WORDS[at]} == = ]] || words+=("${COMP_WORDS[at]}")
    (( at += 1 ))
  done
  [[ $word != = ]] || word=
  if (( ${#words[@]} == 0 )); then
    kind=start
    [[ $word != -* ]] || kind="word $(_simbench_options '') $(_simbench_options {{default_command}})"
    _simbench_complete "$kind" "$word" "$program"
    return
  fi
  command=${words[0]}
  if [[ $command == -* ]]; then
    command={{default_command}}
  else
    words=("${words[@]:1}")
    if [[ " $_simbench_commands " != *" $command "* ]]; then
      scenario=$command command={{default_command}}
    fi
  fi
  for at in "${words[@]}"; do
    if [[ -n $option ]]; then
      [[ $option != --scenario ]] || scenario=$at
      option=
    elif [[ $at == -* ]]; then
      option=$at
      [[ $(_simbench_value "$command" "$option") != - ]] || option=
    else
      [[ $command != describe || $place != 0 ]] || scenario=$at
      (( place += 1 ))
    fi
  done
  if [[ -n $option ]]; then
    kind=$(_simbench_value "$command" "$option")
  elif [[ $word == -* ]]; then
    kind="word $(_simbench_options "$command")"
  else
    kind=$(_simbench_argument "$command" "$place")
  fi
  _simbench_complete "$kind" "$word" "$program" "$scenario"
}

complete -F _simbench simbench
