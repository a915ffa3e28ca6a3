#!/usr/bin/env bash
# debian_packages.sh FOLDER: what the Debian packages in FOLDER are good for (cpack makes them, tests/README.md).
#
# lintian has no error to name. In a clean, minimal Debian 12, which debootstrap makes: installed, used by somebody without
# rights from the installed tree alone, and removed without a trace. Needs root (a root of its own is mounted) and the
# network; takes three to five minutes. At the end stand the sizes of the packages.
set -euo pipefail
source=$(cd "$(dirname "$0")/../.." && pwd)
packages=$(cd "${1:?which folder has the packages?}" && pwd)

skip() { echo "Skipped: $1"; exit 77; }
[ "$(id -u)" = 0 ] || skip "needs root"
command -v debootstrap > /dev/null || skip "needs debootstrap"
if [ -z "${IN_OWN_MOUNTS:-}" ]; then
  unshare -m true 2> /dev/null || skip "may not mount"
  IN_OWN_MOUNTS=1 exec unshare -m "$0" "$@"
fi

work=$(mktemp -d)
root=$work/root
trap 'cd /; umount -R "$root/proc" "$root/dev" 2> /dev/null || true; rm -rf --one-file-system "$work"' EXIT
part() { printf '=== %s (after %d s)\n' "$1" $SECONDS; }
inside() { chroot "$root" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/tmp/home LC_ALL=C.UTF-8 \
             DEBIAN_FRONTEND=noninteractive "$@"; }
apt() { inside apt-get -q -y --no-install-recommends "$@" > "$work/apt.log" 2>&1 || { cat "$work/apt.log"; exit 1; }; }
deb() { printf '/tmp/packages/%s' "$(basename "$packages/$1"_*.deb)"; }
# Somebody without rights, in the folder that has the sample.
someone() { inside setpriv --reuid 4321 --regid 4321 --clear-groups bash -euo pipefail -c "cd /tmp/home; $1"; }
files() {
  (cd "$root" && find . -xdev \( -path ./proc -o -path ./dev -o -path ./tmp -o -path ./var/cache -o -path ./var/lib/apt \
     -o -path ./var/lib/dpkg -o -path ./var/log -o -path ./etc/ld.so.cache \) -prune -o -print | sort)
}

part "lintian"
if command -v lintian > /dev/null; then
  lintian --allow-root --fail-on error "$packages"/*.deb
else
  echo "Skipped: no lintian"
fi

part "A minimal Debian"
mirror=$(apt-get indextargets --format '$(SITE)' 'Created-By: Packages' | head -1)
debootstrap --variant=minbase bookworm "$root" "$mirror" > "$work/log" 2>&1 || { tail -20 "$work/log"; exit 1; }
mount --bind /proc "$root/proc"
mount --bind /dev "$root/dev"
cp /etc/resolv.conf "$root/etc/"
apt update
mkdir -m 777 "$root/tmp/home" "$root/tmp/packages"
cp "$packages"/*.deb "$root/tmp/packages"
cp "$source/examples/handstand.c3d" "$root/tmp/home"
cp -r "$source/examples/external_plugin" "$source/tests/packaging/consumer" "$root/tmp/home"
# The block of Python in the README, without its picture, which needs matplotlib.
awk '/^```/ { inside = $0 == "```python"; next } inside' "$source/README.md" | grep -v -e plot -e savefig \
  | sed 's|examples/||' > "$root/tmp/home/readme.py"
echo 'print("python:", result.verdict, recording.markers.shape)' >> "$root/tmp/home/readme.py"

part "Program"
files > "$work/minimal"
apt install "$(deb mmm-converter-s2kf)"
someone 'MMMConverterS2KF --version
  MMMConverterS2KF info handstand.c3d > /dev/null
  MMMConverterS2KF convert handstand.c3d --height 1.8 -o handstand_mmm.xml --report handstand.html
  MMMConverterS2KF check-dynamics handstand_mmm.xml > /dev/null
  MMMConverterS2KF calibrate handstand.c3d --height 1.8 -o anna.xml > /dev/null
  MMMConverterS2KF convert handstand.c3d --subject-file anna.xml -c s2kf_offline -o again.xml > /dev/null
  MMMConverterS2KF export-poses handstand_mmm.xml -o poses.npz
  MMMConverterS2KF print-config JacobianConverter | grep -q "<ConverterConfig"
  MMMConverterS2KF live replay:handstand.c3d@max --height 1.8 -o live.xml > /dev/null
  source /usr/share/bash-completion/completions/MMMConverterS2KF
  COMP_WORDS=(MMMConverterS2KF convert -c s2kf_o) COMP_CWORD=3
  _MMMConverterS2KF MMMConverterS2KF || true  # bash itself does not complete here
  test "${COMPREPLY[*]}" = s2kf_offline'

part "Removed"
apt purge --autoremove mmm-converter-s2kf
files > "$work/removed"
diff "$work/minimal" "$work/removed" || { echo "these files came or went"; exit 1; }

part "Manual, completion, library and Python beside their tools"
apt install man-db groff-base bash-completion g++ cmake ninja-build pkg-config python3-numpy libeigen3-dev
inside mkdir -p /var/cache/man
files > "$work/tools"
apt install "$(deb mmm-converter-s2kf)" "$(deb libmmm-converter-s2kf-dev)" "$(deb python3-mmmconverter)"
someone 'man MMMConverterS2KF-convert | grep -q "^EXAMPLES"
  man MMMConverterS2KF | grep -q check-dynamics
  source /usr/share/bash-completion/bash_completion
  _completion_loader MMMConverterS2KF || test $? = 124
  complete -p MMMConverterS2KF
  python3 readme.py
  cmake -G Ninja -S external_plugin -B plugin -DCMAKE_BUILD_TYPE=Release > /dev/null
  cmake --build plugin > /dev/null
  MMM_CONVERTER_PLUGIN_PATH=plugin/lib/MMMConverterS2KF/plugins MMMConverterS2KF convert handstand.c3d --height 1.8 \
    --frames 0:40 --converter RigidFitConverter -o by_plugin.xml > /dev/null
  g++ -o a.out consumer/consumer.cc $(pkg-config --cflags --libs MMMConverterS2KF)
  ./a.out handstand.c3d consumed.xml'

part "Removed"
apt purge --autoremove mmm-converter-s2kf
files > "$work/removed"
diff "$work/tools" "$work/removed" || { echo "these files came or went"; exit 1; }

part "Done"
for package in "$packages"/*.deb; do
  printf '%8d bytes, installed %6d kB  %s\n' "$(stat -c %s "$package")" "$(dpkg-deb -f "$package" Installed-Size)" \
    "$(basename "$package")"
done
