#!/bin/bash
# tools/fetch_dragon against a file server on this machine and a fake npm: no network is used.
#   fetch_dragon_test.sh TOOL PYTHON
set -euo pipefail
tool=$1 python=$2
work=$(mktemp -d)
server=
trap '[ -z "$server" ] || kill "$server"; rm -rf "$work"' EXIT

fail() { echo "FAILED: $*"; cat "$work/log"; exit 1; }
sum() { sha256sum "$1" | cut -d' ' -f1; }

mkdir -p "$work/www" "$work/src/dragon_recon" "$work/bin"
printf 'ply\nfull\n' >"$work/src/dragon_recon/dragon_vrip.ply"
printf 'ply\nres2\n' >"$work/src/dragon_recon/dragon_vrip_res2.ply"
tar -czf "$work/www/dragon.tar.gz" -C "$work/src" dragon_recon
printf '#!/bin/sh\necho called >>"%s"\nexit 1\n' "$work/npm.calls" >"$work/bin/npm"
chmod +x "$work/bin/npm"
export PATH="$work/bin:$PATH" DREAMPM_CACHE="$work/cache"
export DREAMPM_DRAGON_SHA256 DREAMPM_DRAGON_RES2_SHA256 DREAMPM_STANFORD_URL
DREAMPM_DRAGON_SHA256=$(sum "$work/src/dragon_recon/dragon_vrip.ply")
DREAMPM_DRAGON_RES2_SHA256=$(sum "$work/src/dragon_recon/dragon_vrip_res2.ply")

# port 0: the system picks a free one, and the server tells which
"$python" -u - "$work/www" >"$work/port" 2>/dev/null <<'PY' &
import functools, http.server, sys
handler = functools.partial(http.server.SimpleHTTPRequestHandler, directory=sys.argv[1])
with http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
    print(server.server_address[1], flush=True)
    server.serve_forever()
PY
server=$!
for _ in $(seq 100); do [ -s "$work/port" ] && break; sleep 0.1; done
[ -s "$work/port" ] || fail "no file server"
base=http://127.0.0.1:$(cat "$work/port")

# an address without the file: exit 1, the remedies are named, nothing is left behind
DREAMPM_STANFORD_URL=$base/nothing.tar.gz
if "$tool" >"$work/log" 2>&1; then fail "a missing archive must be an error"; fi
grep -q -- '--model FILE' "$work/log" && grep -q asset:knot "$work/log" || fail "the remedies are not named"
[ -z "$(ls -A "$work/cache")" ] || fail "left behind: $(ls "$work/cache")"

# wrong content is refused
DREAMPM_STANFORD_URL=$base/dragon.tar.gz
if DREAMPM_DRAGON_SHA256=00 "$tool" >"$work/log" 2>&1; then fail "a wrong sum must be an error"; fi
grep -q 'SHA-256 differs' "$work/log" || fail "the wrong sum is not told"
[ -z "$(ls -A "$work/cache")" ] || fail "left behind: $(ls "$work/cache")"

# right content is kept
"$tool" >"$work/log" 2>&1 || fail "the archive was not taken"
cmp <(gzip -dc "$work/cache/dragon_vrip.ply.gz") "$work/src/dragon_recon/dragon_vrip.ply" || fail "content"
cmp <(gzip -dc "$work/cache/dragon_vrip_res2.ply.gz") "$work/src/dragon_recon/dragon_vrip_res2.ply" || fail "content"
[ "$(ls "$work/cache" | wc -l)" = 2 ] || fail "left behind: $(ls "$work/cache")"

# a second call asks nobody; a damaged file is fetched anew
calls=$(wc -l <"$work/npm.calls")
DREAMPM_STANFORD_URL=$base/nothing.tar.gz "$tool" >"$work/log" 2>&1 || fail "the cache was not used"
[ "$(wc -l <"$work/npm.calls")" = "$calls" ] || fail "npm was asked although the cache is full"
head -c 20 "$work/cache/dragon_vrip.ply.gz" >"$work/cut" && mv "$work/cut" "$work/cache/dragon_vrip.ply.gz"
"$tool" >"$work/log" 2>&1 || fail "a damaged file was not fetched anew"
cmp <(gzip -dc "$work/cache/dragon_vrip.ply.gz") "$work/src/dragon_recon/dragon_vrip.ply" || fail "content"

# a cache that cannot be made
printf x >"$work/file"
if DREAMPM_CACHE=$work/file/cache "$tool" >"$work/log" 2>&1; then fail "a cache under a file must be an error"; fi
grep -q 'cannot write' "$work/log" || fail "the reason is not told"
echo passed
