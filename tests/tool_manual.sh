# SPDX-License-Identifier: MIT
# Manual pages and completions: every option of every command is in them, roff and the
# shells take them, and bash completes what is right.
. "$(dirname "$0")/tool_lib.sh"

mkdir pages
good help --pages pages
commands=$("$tool" help | sed -n 's/^  \([a-z]*\)  .*/\1/p')
[ "$(echo "$commands" | wc -l)" -ge 7 ] || fail "commands: $commands"
for command in $commands; do
    "$tool" help "$command" | grep -o '^  \(-[a-z], \)\{0,1\}--[a-z0-9-]*' |
        sed 's/.*--/--/' | sort -u >flags.txt
    [ -s flags.txt ] || fail "$command has no options"
    while read -r flag; do
        roff=$(printf '%s' "$flag" | sed 's/-/\\\\-/g')
        grep -q "^\\\\fB.*$roff\\( \\|\\\\fR\\)" "pages/crevice-$command.1" ||
            fail "$flag is not in crevice-$command.1"
        grep -q "^        $command) words='.*$flag " pages/crevice.bash ||
            fail "$flag of $command is not in crevice.bash"
        grep -q -- "[*}'(, ]$flag[]['}(]" pages/_crevice || fail "$flag of $command is not in _crevice"
        grep -q -- "from $command' -l ${flag#--} " pages/crevice.fish ||
            fail "$flag of $command is not in crevice.fish"
    done <flags.txt
    good help --man "$command"
    cmp -s stdout.txt "pages/crevice-$command.1" || fail "help --man $command is another page"
    grep -q "^\\.BR crevice.-$command (1)" pages/crevice.1 || fail "$command is not in crevice.1"
    # The words are those of the help: its options, and a piece of each text.
    "$tool" help "$command" | sed -n 's/^  --json  *\(.*\)/\1/p' >text.txt
    if [ -s text.txt ]; then
        grep -q "^$(sed 's/-/\\\\-/g; s/\[/\\[/g' text.txt | cut -c1-40)" "pages/crevice-$command.1" ||
            fail "the page of $command says something else: $(cat text.txt)"
    fi
done

# What formats them finds nothing to say.
for page in pages/*.1; do
    if command -v groff >/dev/null && groff -man -T utf8 -z /dev/null 2>/dev/null; then
        groff -man -T utf8 -ww -z "$page" 2>groff.txt || fail "groff: $page"
        [ ! -s groff.txt ] || fail "groff: $page: $(cat groff.txt)"
    fi
    if command -v mandoc >/dev/null; then
        mandoc -T lint -W error "$page" >mandoc.txt || fail "mandoc: $(cat mandoc.txt)"
    fi
done
if command -v zsh >/dev/null; then
    zsh -n pages/_crevice || fail "zsh does not take _crevice"
fi
if command -v fish >/dev/null; then
    fish --no-config -n pages/crevice.fish || fail "fish does not take crevice.fish"
    fish --no-config -c 'source pages/crevice.fish; complete -C "crevice render --preset m"' >fish.txt
    grep -q '^medium' fish.txt || fail "fish: $(cat fish.txt)"
fi

# complete WANTED WORD...: what bash offers for the last word.
complete() {
    wanted=$1
    shift
    # shellcheck disable=SC2016 # for bash
    offered=$(bash --norc -c '. pages/crevice.bash
        COMP_WORDS=("$@") COMP_CWORD=$(($# - 1))
        _crevice crevice "${@: -1}" "${@: -2:1}"
        echo "${COMPREPLY[*]}"' bash crevice "$@") || fail "bash: $*"
    [ "$offered" = "$wanted" ] || fail "crevice $*: bash offers \"$offered\", not \"$wanted\""
}
if command -v bash >/dev/null; then
    touch frame.exr
    complete 'gbuffer' g
    complete 'hbao hsao' render --method h
    complete 'medium' ao --preset m
    complete 'hbao,alchemy' bench --method hbao,al
    complete 'box4' render --filter = bo
    complete 'frame.exr' ao fr
    complete 'frame.exr' ao --output fr
    complete '--quiet' render model.glb --qui
    complete 'cpu vulkan' render --device ''
    complete 'surfaces solid' gbuffer --layer-kind s
fi

bad 2 'help --man: give\|no such command' help --man renderr
bad 2 'bash, zsh or fish' help --completion tcsh
bad 1 'nowhere/crevice.1: cannot be written' help --pages nowhere
