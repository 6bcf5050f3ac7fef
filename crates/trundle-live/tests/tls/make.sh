#!/bin/sh
# Makes the certificates of the test of TLS. The keys protect nothing.
set -e
cd "$(dirname "$0")"
make() { # NAME KEY NOT_BEFORE NOT_AFTER
    openssl req -new -key "$2" -subj "/CN=trundle test" -out request.pem
    printf 'subjectAltName=IP:127.0.0.1,DNS:localhost\nbasicConstraints=CA:FALSE\n' > extensions
    : > index; echo 01 > serial
    printf '[ca]\ndefault_ca=d\n[d]\ndatabase=index\nserial=serial\nnew_certs_dir=.\ndefault_md=sha256\npolicy=p\nemail_in_dn=no\nrand_serial=yes\nunique_subject=no\n[p]\ncommonName=supplied\n' > ca.cnf
    openssl ca -batch -notext -selfsign -config ca.cnf -keyfile "$2" -in request.pem -startdate "$3" -enddate "$4" -extfile extensions -out "$1"
    rm -f request.pem extensions index* serial* ca.cnf ./*.pem
}
openssl ecparam -name prime256v1 -genkey -noout | openssl pkcs8 -topk8 -nocrypt -out page.key
openssl ecparam -name prime256v1 -genkey -noout | openssl pkcs8 -topk8 -nocrypt -out other.key
make page.crt page.key 20260101000000Z 21260101000000Z
make expired.crt page.key 20200101000000Z 20210101000000Z
make future.crt page.key 21200101000000Z 21260101000000Z
