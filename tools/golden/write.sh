#!/bin/sh
# Writes golden/vectors and golden/MANIFEST anew from tools/golden and validation/theory. Only for a change of the model or of the form of the
# files: a failing check is never mended by running this.
set -eu
cd "$(dirname "$0")/../.."
if ! git diff --quiet HEAD -- tools/golden validation/theory; then
    echo "write.sh: tools/golden or validation/theory has changes that are not committed; the manifest would name the wrong version" >&2
    exit 2
fi
make -s build/vectors
mkdir -p golden/vectors
build/vectors golden/vectors
{
    cat <<MANIFEST
# Checksums of golden data, and where they come from. \`sha256sum -c MANIFEST\` in this folder, or \`make vectors\`, verifies them.
#
# vectors/: expected values of single terms, layers 1 and 2
#   command         tools/golden/write.sh (build/vectors golden/vectors; sources tools/golden and validation/theory)
#   version         $(git log -1 --format=%h -- tools/golden validation/theory), version 1.0 of the form (docs/vectors.schema.json)
#   date            $(git log -1 --format=%cs -- tools/golden validation/theory)
#   scene, seeds    in the files: every input is written out; states come from splitmix64 with seeds 1 to 24 (tools/golden)
#   cost            below one second
#   error           rounding of double arithmetic; the tolerance that each file states is for codes that read it
#   confirmed by    make audit: each number again in quadruple precision by another derivation (tools/audit)
#                   make vectors: the solver, which shares no source with validation/theory, through files
#                   per term, published or exact: docs/verdicts.md and the heads of validation/theory/*.c
MANIFEST
    (cd golden && sha256sum vectors/*.json)
} >build/MANIFEST
mv build/MANIFEST golden/MANIFEST
