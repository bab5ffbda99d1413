# fish completion for simbench; made by `simbench completion fish`.

# The command of the line so far; empty while there is none.
function __simbench_command
    set -l words (commandline -opc)
    set -e words[1]
    if not set -q words[1]
        return
    end
    if contains -- $words[1] (__simbench_commands)
        echo $words[1]
    else
        echo {{default_command}}
    end
end

function __simbench_is
    test (count (__simbench_command)) -gt 0; and test (__simbench_command) = $argv[1]
end

# The options of the default command stand for it.
function __simbench_starts
    test (count (__simbench_command)) -eq 0
end

function __simbench_scenarios
    set -l words (commandline -opc)
    eval (string escape -- $words[1]) list scenarios --format names 2>/dev/null
    __fish_complete_path (commandline -ct)
end

function __simbench_names
    set -l words (commandline -opc)
    eval (string escape -- $words[1]) list $argv --format names 2>/dev/null
end

# Folders, and files of results.
function __simbench_archives
    __fish_complete_directories (commandline -ct)
    __fish_complete_suffix .json
end

# The line's scenario: after --scenario, a word in place of the command, or what describe describes.
function __simbench_scenario
    set -l words (commandline -opc)
    set -e words[1]
    if set -l at (contains -i -- --scenario $words)
        echo $words[(math $at + 1)]
    else if test "$words[1]" = describe
        echo $words[2]
    else if not contains -- $words[1] (__simbench_commands)
        echo $words[1]
    end
end

function __simbench_pipelines
    set -l scenario (__simbench_scenario)
    test -n "$scenario"; or return
    set -l before (commandline -ct | string replace -r '[^,]*$' '')
    for name in (__simbench_names pipelines --scenario (string escape -- $scenario))
        echo $before$name
    end
end

function __simbench_pointers
    set -l words (commandline -opc)
    set -l scenario (__simbench_scenario)
    test -n "$scenario"; or return
    eval (string escape -- $words[1] describe $scenario) --format names 2>/dev/null | string replace -r '$' =
end

complete -c simbench -f
