#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
#
# Subject    Aravis 0.8.26 (Debian 12, aravis-tools 0.8.26-1), formulas of a GenICam description
# Behaviour  An IntSwissKnife or IntConverter whose formula has a function of real numbers (ROUND,
#            CEIL, FLOOR, TRUNC, SQRT, ABS, ...) reads 0, and no error is reported. The evaluator
#            itself has the error "invalid double function"; the node drops it. The same formula in
#            a SwissKnife is evaluated.
# Expected   The value, or an error from arv_device_get_integer_feature_value.
# Matters    Makers compute PayloadSize with CEIL and principal points with ROUND: buffers of
#            0 bytes, and a principal point at 0 that nobody tells from a true one.
# Needs      apt-get with package lists, dpkg, the loopback network
set -euo pipefail

work=$(mktemp -d)
camera=
trap '[ -z "$camera" ] || kill "$camera" 2>/dev/null; rm -rf "$work"' EXIT
cd "$work"

# The programs, and what they depend on and this machine lacks.
mkdir -p debs/partial
if ! apt-get -y -o Dir::Cache::archives="$work/debs" -o Debug::NoLocking=1 \
  -o APT::Sandbox::User="$(id -un)" --no-install-recommends --reinstall --allow-downgrades \
  --download-only install aravis-tools-cli=0.8.26-1 libaravis-0.8-0=0.8.26-1 \
  >apt.log 2>&1; then
  cat apt.log >&2
  exit 1
fi
# The fake camera, without the graphical programs' libraries.
(cd debs && apt-get -o APT::Sandbox::User="$(id -un)" download aravis-tools=0.8.26-1) >apt.log 2>&1
for package in debs/*.deb; do dpkg -x "$package" root; done
libraries=root/usr/lib/x86_64-linux-gnu
export LD_LIBRARY_PATH=$PWD/$libraries

# A description with the same formulas of integers and of real numbers; Width is 256.
value() {
  cat <<XML
  <$1 Name="$2">
    <pVariable Name="W">Width</pVariable>
    <Formula>$3</Formula>
  </$1>
XML
}
{
  cat <<'XML'
<?xml version="1.0" encoding="utf-8"?>
<RegisterDescription ModelName="Formulas" VendorName="Test" StandardNameSpace="None"
    SchemaMajorVersion="1" SchemaMinorVersion="1" SchemaSubMinorVersion="0" MajorVersion="1"
    MinorVersion="0" SubMinorVersion="0" ProductGuid="0" VersionGuid="0"
    xmlns="http://www.genicam.org/GenApi/Version_1_1">
  <Category Name="Root"/>
  <Integer Name="Width"><Value>256</Value></Integer>
  <Port Name="Device"/>
XML
  value IntSwissKnife IntHalf 'W/2'
  value IntSwissKnife IntRoundedHalf 'ROUND(W/2)'
  value IntSwissKnife IntCeil 'CEIL(W*1.5)'
  value IntSwissKnife IntAbs 'ABS(0-W)'
  value SwissKnife RealRoundedHalf 'ROUND(W/2)'
  value SwissKnife RealCeil 'CEIL(W*1.5)'
  echo '</RegisterDescription>'
} >genicam.xml

root/usr/bin/arv-fake-gv-camera-0.8 -i 127.0.0.1 -g genicam.xml >camera.log 2>&1 &
camera=$!
for _ in $(seq 10); do
  timeout 5 root/usr/bin/arv-tool-0.8 -a 127.0.0.1 control Width >ready.log 2>&1 || true
  if grep -q 256 ready.log; then break; fi
  sleep 0.5
done

for name in IntHalf IntRoundedHalf IntCeil IntAbs RealRoundedHalf RealCeil; do
  status=0
  timeout 20 root/usr/bin/arv-tool-0.8 -a 127.0.0.1 control "$name" >log 2>&1 || status=$?
  echo "$(cat log), exit $status"
done | tee seen

cat >expected <<'SEEN'
IntHalf = 128, exit 0
IntRoundedHalf = 0, exit 0
IntCeil = 0, exit 0
IntAbs = 0, exit 0
RealRoundedHalf = 128, exit 0
RealCeil = 384, exit 0
SEEN

if ! diff expected seen; then
  echo "the behaviour has changed" >&2
  exit 1
fi
