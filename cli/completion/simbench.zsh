#compdef simbench
# zsh completion for simbench; made by `simbench completion zsh`.

_simbench_scenarios() {
  local -a names
  names=(${(f)"$(_call_program scenarios ${(q)_simbench_program} list scenarios --format names 2> /dev/null)"})
  _alternative 'scenarios:scenario:compadd -a names' 'files:scenario file:_files'
}

_simbench_command_names() {
  _describe -t commands command _simbench_commands
}

_simbench_figures() {
  local -a names
  names=(${(f)"$(_call_program figures ${(q)_simbench_program} list figures --format names 2> /dev/null)"})
  compadd -a names
}

# Folders with results.json, or with a folder that has one.
_simbench_archives() {
  _alternative 'archives:archive:_files -/' 'files:results.json:_files -g "*.json"'
}

# The line's scenario: after --scenario, or what `describe` describes.
_simbench_scenario() {
  local -i at=${words[(I)--scenario]}
  local word
  REPLY=
  [[ ${words[1]} != describe ]] || REPLY=${words[2]}
  (( ! at )) || REPLY=${words[at+1]}
  for word in $words; do
    [[ $word != --scenario=* ]] || REPLY=${word#--scenario=}
  done
  [[ -n $REPLY ]]
}

_simbench_pipelines() {
  local REPLY
  _simbench_scenario || return 1
  local -a names
  names=(${(f)"$(_call_program pipelines ${(q)_simbench_program} list pipelines --scenario ${(q)REPLY} --format names 2> /dev/null)"})
  compset -P '*,'
  compadd -S '' -a names
}

_simbench_pointers() {
  local REPLY
  _simbench_scenario || return 1
  local -a names
  names=(${(f)"$(_call_program parameters ${(q)_simbench_program} describe ${(q)REPLY} --format names 2> /dev/null)"})
  compadd -S = -a names
}

{{tables}}
# Options without a command are those of the default command.
_simbench() {
  local _simbench_program=$words[1] curcontext=$curcontext
  if (( CURRENT == 2 )); then
    if [[ $PREFIX == -* ]]; then
      _arguments -S $_simbench_program_options $_simbench_{{default_command}}
    else
      _describe -t commands command _simbench_commands || _simbench_scenarios
    fi
    return
  fi
  if [[ $words[2] == -* ]]; then
    words=($words[1] {{default_command}} "${(@)words[2,-1]}")
    (( CURRENT += 1 ))
  elif [[ -z ${(M)_simbench_commands:#${words[2]}:*} ]]; then
    words=($words[1] {{default_command}} --scenario "${(@)words[2,-1]}")
    (( CURRENT += 2 ))
  fi
  local specs=_simbench_${words[2]//-/_}
  (( ${(P)+specs} )) || return 1
  shift words
  (( CURRENT -= 1 ))
  _arguments -S "${(@P)specs}"
}

if [[ $zsh_eval_context[-1] == loadautofunc ]]; then
  _simbench "$@"
else
  compdef _simbench simbench
fi
