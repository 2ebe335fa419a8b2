#!/bin/sh
# image.sh WORK SOURCE TRACTION TRACTION_SLOT TRACTIOND PYTHON - traction flash --image without QEMU: the same bytes each time, read back node by
# node by a second reader (jffs2_list.py), the slots in it are those that the board's own installer makes, every refusal
# leaves no file. That Linux mounts and boots it: tests/emulate/image.sh.
set -eu
work=$1 source=$2 traction=$3 slot=$4 tractiond=$5 python=$6
rm -rf "$work"
mkdir -p "$work"
cd "$work"
work=$(pwd)
fail() { echo "FAILED: $*"; for file in out err; do [ ! -s "$file" ] || { echo "--- $file"; tail -n 25 "$file"; }; done; exit 1; }
run() { # run EXPECTED_CODE COMMAND...
    expected=$1
    shift
    code=0
    "$@" >out 2>err || code=$?
    [ "$code" -eq "$expected" ] || fail "$* ended with $code, expected $expected"
}
says() { grep -qF -- "$1" out err || fail "expected: $1"; }
machine=$(dpkg --print-architecture 2>/dev/null || echo amd64) # of the program that is packed here, which is this machine's
image() { # image OUT OPTION...
    out=$1
    shift
    "$traction" flash p.tar --image "$out" --key key.pub --architecture "$machine" "$@"
}
run 0 "$traction" flash --new-key key
run 0 "$traction" flash --pack p.tar --key key --program "$tractiond" --rover lhomme_desages

# --- the same bytes, whoever makes it, where and when
run 0 image one.img
says 'erase blocks of 256 kB'
says "$(sha256sum <one.img | cut -d ' ' -f 1)"
mkdir elsewhere
cp p.tar key.pub elsewhere
sleep 1
run 0 sh -c "umask 077; cd elsewhere && TZ=Asia/Tokyo '$traction' flash p.tar --image two.img --key key.pub --architecture $machine --rover lhomme_desages"
cmp one.img elsewhere/two.img || fail "the same package gave another image"

# --- what is in it: the slots, byte for byte those of the board's installer on a folder
run 0 "$python" "$source/tests/flash/jffs2_list.py" one.img 262144
sed -n 's/ opt\/traction\// /p' out | grep -v '^04' >listed
run 0 "$slot" --folder "$work/slots" init --key key.pub --rover Lhomme-Desages
"$slot" --folder "$work/slots" install <p.tar >out 2>err || fail "the installer on a folder"
(cd slots && find . -type f ! -name lock ! -name state | LC_ALL=C sort | while read -r file; do
    echo "$(stat -c '10%04a 0:0 %s' "$file" | sed 's/^10\(....\)/10\1/') $(sha256sum <"$file" | cut -d ' ' -f 1) ${file#./}"
done) >expected
grep -v ' state$' listed | LC_ALL=C sort -k 5 >without
LC_ALL=C sort -k 5 expected >want
cmp want without || { diff want without || true; fail "the image's slots are not the installer's"; }
[ "$(wc -l <want)" -eq 10 ] || fail "ten files were expected"
{ printf 'traction-slots 1\ngood a 0 %s\ntrial - 0\nnote confirmed 0\n' "$(sed -n 's/^id //p' key)"; } >state # firmware/flash/slots.c
echo "check $(sha256sum <state | cut -d ' ' -f 1)" >>state
grep -q "$(sha256sum <state | cut -d ' ' -f 1) state\$" listed || fail "the state does not say that slot a is the good one"

# --- a flash of a given size, other erase blocks, a system with links and a device
run 0 image sized.img --size 65536
[ "$(stat -c %s sized.img)" -eq 67108864 ] || fail "not 64 MB"
run 0 "$python" "$source/tests/flash/jffs2_list.py" sized.img 262144
run 0 image small.img --erase-block 16
run 0 "$python" "$source/tests/flash/jffs2_list.py" small.img 16384
mkdir -p system/usr/sbin system/bin system/etc/empty
cp "$slot" system/usr/sbin/traction-slot
ln -s ../usr/sbin/traction-slot system/bin/slot
head -c 12288 /dev/zero >system/etc/pages
: >system/etc/nothing
chmod 600 system/etc/nothing
run 0 image root.img --system system
run 0 "$python" "$source/tests/flash/jffs2_list.py" root.img 262144
says "020600 0:0 2 5,1 dev/console"
says "120777 0:0 25 $(printf ../usr/sbin/traction-slot | sha256sum | cut -d ' ' -f 1) bin/slot"
says "100600 0:0 0 $(sha256sum </dev/null | cut -d ' ' -f 1) etc/nothing"
says "100644 0:0 12288 $(sha256sum <system/etc/pages | cut -d ' ' -f 1) etc/pages"
says "etc/empty"
says "opt/traction/a/manifest"

# --- a reader that sees a changed byte
{ head -c 200000 one.img; printf 'x'; tail -c +200002 one.img; } >spoilt.img
run 1 "$python" "$source/tests/flash/jffs2_list.py" spoilt.img 262144

# --- what is refused leaves no file
refused() { # refused EXPECTED_CODE WORDS OPTION...
    words=$2
    code=$1
    shift 2
    run "$code" "$traction" flash "$@" --image no.img
    says "$words"
    [ ! -e no.img ] || fail "refused, and written: $*"
}
refused 2 'needs the package' --key key.pub
refused 2 'needs the key' p.tar
refused 2 'four things' p.tar --key key.pub --host board
refused 3 "the package is for the architecture $machine, this is armel" p.tar --key key.pub
run 0 "$traction" flash --new-key other
refused 3 'and this rover obeys the key' p.tar --key other.pub --architecture "$machine"
sed 's/^name = .*/name = "Another"/' "$source/rovers/lhomme_desages.toml" >another.toml
refused 3 'the package is for the rover Lhomme-Desages, this is Another' p.tar --key key.pub --architecture "$machine" --rover another.toml
cp p.tar unsigned.tar
tar --delete -f unsigned.tar manifest.sig
refused 3 'unsigned.tar' unsigned.tar --key key.pub --architecture "$machine"
{ head -c 100000 p.tar; printf 'x'; tail -c +100002 p.tar; } >changed.tar
refused 3 'changed.tar' changed.tar --key key.pub --architecture "$machine"
head -c 100000 p.tar >cut.tar
refused 3 'cut.tar' cut.tar --key key.pub --architecture "$machine"
refused 3 'kB are needed' p.tar --key key.pub --architecture "$machine" --size 2048
refused 3 'a multiple of the erase block' p.tar --key key.pub --architecture "$machine" --size 2050
refused 3 'a multiple of 4096' p.tar --key key.pub --architecture "$machine" --erase-block 10
refused 3 'does not lie below /flash' p.tar --key key.pub --architecture "$machine" --mount /flash
refused 3 'nothing would start a version' p.tar --key key.pub --architecture "$machine" --system elsewhere
refused 3 'the image is for armel' p.tar --key key.pub --system system
mkdir -p system/opt/traction
refused 3 'has slots already' p.tar --key key.pub --architecture "$machine" --system system
run 2 "$traction" flash p.tar --image p.tar --key key.pub --architecture "$machine"
says 'names a file that is read'
run 4 image /nowhere/no.img
run 4 image /dev/full
echo kept >kept.img
run 3 image kept.img --rover another.toml
[ "$(cat kept.img)" = kept ] || fail "an image that was refused replaced a file"
ls -A | grep -E '^\.' && fail "something half-written stays behind" || true
echo "an image of $(stat -c %s one.img) bytes, the same twice, whole, its slots the installer's; every refusal left no file"
