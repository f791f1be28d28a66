#!/bin/sh
# A program that answers in full and then ends with an error: ends_badly.sh PROGRAM... CASE_DIR OUT_DIR
"$@"
exit 1
