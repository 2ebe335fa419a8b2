# system.sh - a minimal Debian for the scripts beside it, which source it with $here (the checkout), $suite and $keep set.
# Needs root, debootstrap and a package mirror; copies this machine's way to the package index (apt's proxy and certificates, pip's and
# npm's settings), and ../shared where it exists.
# TRACTION_BARE: the folder in which the system is made (default: a temporary one); --keep leaves it there.
# TRACTION_BARE_CACHE: a folder of ccache's, for a run that is repeated: what it took to build is then not told, for it is not a first time.
# Gives: say, die; timed NAME COMMAND...; make_system, and after it $system, $inside (a program: COMMAND... in that system) and $enter.
say() { echo "bare: $*"; }
die() { say "$*" >&2; exit 1; }
[ "$(id -u)" -eq 0 ] || die "needs root, for debootstrap and chroot"
command -v debootstrap >/dev/null || { say "SKIPPED: no debootstrap here (apt-get install debootstrap)"; exit 77; }
git -C "$here" diff --quiet HEAD -- || say "the clone has what is committed; this checkout has changes beside that"

base=${TRACTION_BARE:-$(mktemp -d)}
system=$base/$suite
# release: what is mounted in the system, by this run or by one that was killed
release() {
    awk -v below="$system/" 'index($2, below) == 1 { print $2 }' /proc/mounts | sort -r | while read -r place; do umount "$place" || umount -l "$place"; done
    ! grep -q " $system/" /proc/mounts || { say "$system has mounts that cannot be released (/proc/mounts); it is left as it is" >&2; return 1; }
}
# remove_system: never through a mount
remove_system() { release && rm -rf --one-file-system "$system"; }
leave() { if [ "$keep" = yes ]; then release; else remove_system; fi || true; }
trap leave EXIT
trap 'exit 130' INT TERM

# the mirror that apt uses here; debootstrap's own choice otherwise
mirror=$(sed -n 's/^URIs: *\([^ ]*\/debian\)\/* *$/\1/p; s/^deb  *\(\[[^]]*\] *\)*\([^ ]*\/debian\)\/* .*/\2/p' /etc/apt/sources.list /etc/apt/sources.list.d/*.sources /etc/apt/sources.list.d/*.list 2>/dev/null | head -n 1)

# timed NAME COMMAND...: its wall and CPU seconds, its output to NAME.log
timed() {
    name=$1
    shift
    began=$(date +%s.%N)
    status=0
    # shellcheck disable=SC2016
    bash -c 'TIMEFORMAT="%R %U %S"; log=$1; shift; time "$@" >"$log" 2>&1' bash "$base/$suite.$name.log" "$@" 2>"$base/$suite.$name.time" || status=$?
    tail -n 1 "$base/$suite.$name.time" | awk -v name="$name" '{ printf "bare: %-22s %6.0f s, %6.0f CPU s\n", name, $1, $2 + $3 }'
    if [ "$status" -ne 0 ]; then
        tail -n 40 "$base/$suite.$name.log"
        keep=yes
        die "$name failed with $status; its output: $base/$suite.$name.log, the system: $system"
    fi
}

# make_system: the system, this checkout cloned into it, what its apt offers
make_system() {
    say "$suite${mirror:+ from this machine's mirror}, checkout $(git -C "$here" rev-parse --short HEAD)"
    remove_system || die "nothing was done"
    timed debootstrap debootstrap --variant=minbase "$suite" "$system" ${mirror:+"$mirror"}
    for file in /usr/local/share/ca-certificates/*.crt /etc/apt/apt.conf.d/*proxy* /etc/apt/apt.conf.d/*registry* /etc/ssl/certs/ca-certificates.crt /etc/pip.conf /etc/npmrc /root/.npmrc /root/.config/pip/pip.conf /etc/hosts /etc/resolv.conf; do
        [ -f "$file" ] || continue
        mkdir -p "$system$(dirname "$file")"
        cp -L "$file" "$system$file"
    done
    # devices of its own: this machine's /dev seen through a bind would go with the system, should it be removed by hand
    mount -t proc proc "$system/proc"
    mount -t tmpfs -o mode=755 devices "$system/dev"
    for node in null:3 zero:5 full:7 random:8 urandom:9; do mknod -m 666 "$system/dev/${node%:*}" c 1 "${node#*:}"; done
    mknod -m 666 "$system/dev/tty" c 5 0
    mkdir "$system/dev/pts" "$system/dev/shm"
    mount -t devpts -o newinstance,ptmxmode=666,mode=620 devpts "$system/dev/pts"
    mount -t tmpfs -o mode=1777 shm "$system/dev/shm"
    ln -s pts/ptmx "$system/dev/ptmx"
    ln -s /proc/self/fd "$system/dev/fd"
    for stream in 0:stdin 1:stdout 2:stderr; do ln -s "/proc/self/fd/${stream%:*}" "$system/dev/${stream#*:}"; done
    if [ -n "${TRACTION_BARE_CACHE-}" ]; then
        mkdir -p "$system/root/.ccache" "$TRACTION_BARE_CACHE"
        printf 'base_dir = /root\nhash_dir = false\nsloppiness = pch_defines,time_macros\nmax_size = 5G\n' >"$TRACTION_BARE_CACHE/ccache.conf"
        mount --bind "$TRACTION_BARE_CACHE" "$system/root/.ccache"
    fi
    git clone -q "$here" "$system/root/traction"
    if [ -d "$here/../shared" ]; then cp -r "$here/../shared" "$system/root/shared"; fi

    # "$inside" COMMAND...: in that system, with this machine's settings of proxies, certificates and indexes and nothing else of it
    inside=$base/$suite.inside
    {
        echo '#!/bin/sh'
        echo "exec chroot '$system' /usr/bin/env -i HOME=/root LANG=C.UTF-8 DEBIAN_FRONTEND=noninteractive \\"
        echo "PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin \\"
        env | grep -E '^(https?_proxy|HTTPS?_PROXY|no_proxy|NO_PROXY|SSL_CERT_FILE|NODE_EXTRA_CA_CERTS|PIP_[A-Z_]*|npm_config_[a-z_]*)=' |
            grep -v "'" | sed "s/=\(.*\)/='\1' \\\\/" || true
        echo '"$@"'
    } >"$inside"
    chmod +x "$inside"
    "$inside" apt-get update -q >"$base/$suite.update.log" 2>&1 || die "apt-get update failed ($base/$suite.update.log)"
}
enter='cd /root/traction && '
