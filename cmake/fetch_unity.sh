#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Fetch the source of the Unity test framework into folder $1.
#
# No Debian release packages Unity, but the source of cjson carries it, so it comes through the same signed archive as
# the compiler. apt works on lists of its own in a temporary folder: neither root nor deb-src lines are needed, and the
# system's configuration stays as it is.
set -euo pipefail

target=$(realpath -m "$1")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
chmod 755 "$work"
mkdir -p "$work"/{lists/partial,cache/archives/partial,parts}

# Every binary repository of this system, whichever format it is configured in, as a source repository.
# shellcheck disable=SC2016 # apt expands these, not the shell
apt-get indextargets --format '$(REPO_URI) $(RELEASE) $(COMPONENT) $(SIGNED_BY)' 'Created-By: Packages' |
	sort -u |
	while read -r uri release component key; do
		options=
		[[ $key != /* ]] || options="[signed-by=$key] "
		echo "deb-src $options$uri $release $component"
	done >"$work/sources.list"

apt=(apt-get -q
	-o Dir::Etc::sourcelist="$work/sources.list" -o Dir::Etc::sourceparts="$work/parts"
	-o Dir::State::lists="$work/lists" -o Dir::Cache="$work/cache" -o APT::Sandbox::User=)
cd "$work"
"${apt[@]}" update || true # a repository without sources is no reason to stop
# The archive's signed index vouches for the tar file; mirrors have been seen without the .dsc.
"${apt[@]}" source --tar-only --download-only cjson

mkdir unity
tar -xf cjson_*.orig.tar.* -C unity --strip-components=3 --wildcards \
	'*/tests/unity/src' '*/tests/unity/examples/unity_config.h' # unity_internals.h includes the latter
test -e unity/src/unity.c
mkdir -p "$(dirname "$target")"
rm -rf "$target"
mv unity "$target"
