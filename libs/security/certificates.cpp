// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/security/certificates.hpp"

#include <openssl/bn.h>
#include <openssl/ec.h>
#include <openssl/pem.h>
#include <openssl/rand.h>
#include <openssl/x509v3.h>

#include <ctime>
#include <memory>
#include <utility>

#include "libs/core/error.hpp"
#include "libs/security/openssl.hpp"

namespace palpate::security {

namespace {

using BigNumber = std::unique_ptr<BIGNUM, Freed<BN_free>>;
using Integer = std::unique_ptr<ASN1_INTEGER, Freed<ASN1_INTEGER_free>>;
using Extension = std::unique_ptr<X509_EXTENSION, Freed<X509_EXTENSION_free>>;
using Time = std::unique_ptr<ASN1_TIME, Freed<ASN1_TIME_free>>;

constexpr int kSerialBits = 120;
constexpr int kX509Version3 = 2;
constexpr int kCrlVersion2 = 1;

Key NewKey() {
  Key key(EVP_EC_gen("P-256"));
  CheckOpenSsl(key != nullptr, "making a key");
  return key;
}

std::string ToPem(const Key& key) {
  const Bio sink = NewSink();
  CheckOpenSsl(
      PEM_write_bio_PrivateKey(sink.get(), key.get(), nullptr, nullptr, 0, nullptr, nullptr) == 1,
      "writing a key");
  return TextOf(sink);
}

std::string ToPem(const Certificate& certificate) {
  const Bio sink = NewSink();
  CheckOpenSsl(PEM_write_bio_X509(sink.get(), certificate.get()) == 1, "writing a certificate");
  return TextOf(sink);
}

void SetRandomSerial(X509* certificate) {
  const BigNumber number(BN_new());
  CheckOpenSsl(number && BN_rand(number.get(), kSerialBits, BN_RAND_TOP_ONE, BN_RAND_BOTTOM_ANY) &&
                   BN_to_ASN1_INTEGER(number.get(), X509_get_serialNumber(certificate)),
               "drawing a serial number");
}

void Add(X509* certificate, X509* issuer, int kind, const char* value) {
  X509V3_CTX context;
  X509V3_set_ctx(&context, issuer, certificate, nullptr, nullptr, 0);
  const Extension extension(X509V3_EXT_conf_nid(nullptr, &context, kind, value));
  CheckOpenSsl(extension && X509_add_ext(certificate, extension.get(), -1) == 1,
               std::string("adding the extension ") + value);
}

Certificate NewCertificate(const std::string& common_name, EVP_PKEY* key, const Period& valid) {
  Certificate certificate(X509_new());
  CheckOpenSsl(certificate != nullptr, "making a certificate");
  X509* raw = certificate.get();
  X509_set_version(raw, kX509Version3);
  SetRandomSerial(raw);
  const auto* text = reinterpret_cast<const unsigned char*>(common_name.c_str());
  CheckOpenSsl(X509_NAME_add_entry_by_txt(X509_get_subject_name(raw), "CN", MBSTRING_UTF8, text, -1,
                                          -1, 0) == 1,
               "naming a certificate '" + common_name + "'");
  CheckOpenSsl(ASN1_TIME_set(X509_getm_notBefore(raw), valid.begin_s) &&
                   ASN1_TIME_set(X509_getm_notAfter(raw), valid.end_s) &&
                   X509_set_pubkey(raw, key) == 1,
               "filling a certificate");
  return certificate;
}

std::string ToHex(const ASN1_INTEGER* serial) {
  const BigNumber number(ASN1_INTEGER_to_BN(serial, nullptr));
  char* text = BN_bn2hex(number.get());
  std::string hex(text);
  OPENSSL_free(text);
  return hex;
}

Integer FromHex(const std::string& hex) {
  BIGNUM* raw = nullptr;
  if (BN_hex2bn(&raw, hex.c_str()) == 0) throw InputError("'" + hex + "' is no serial number");
  const BigNumber number(raw);
  return Integer(BN_to_ASN1_INTEGER(number.get(), nullptr));
}

std::int64_t ToSeconds(const ASN1_TIME* time) {
  std::tm parts{};
  CheckOpenSsl(ASN1_TIME_to_tm(time, &parts) == 1, "reading a date");
  return timegm(&parts);
}

Time TimeOf(std::int64_t time_s) {
  Time time(ASN1_TIME_set(nullptr, time_s));
  CheckOpenSsl(time != nullptr, "writing a date");
  return time;
}

}  // namespace

Credentials CreateAuthority(const std::string& common_name, AuthorityUse use, const Period& valid) {
  const Key key = NewKey();
  const Certificate certificate = NewCertificate(common_name, key.get(), valid);
  X509* raw = certificate.get();
  X509_set_issuer_name(raw, X509_get_subject_name(raw));
  const bool issues = use == AuthorityUse::kIdentities;
  Add(raw, raw, NID_basic_constraints, issues ? "critical,CA:TRUE,pathlen:0" : "critical,CA:FALSE");
  Add(raw, raw, NID_key_usage,
      issues ? "critical,keyCertSign,cRLSign" : "critical,digitalSignature");
  Add(raw, raw, NID_subject_key_identifier, "hash");
  CheckOpenSsl(X509_sign(raw, key.get(), EVP_sha256()) > 0, "signing a certificate");
  return {ToPem(certificate), ToPem(key)};
}

Credentials IssueIdentity(const Credentials& authority, const std::string& common_name,
                          const Period& valid) {
  const Certificate issuer = ParseCertificate(authority.certificate_pem);
  const Key issuer_key = ParseKey(authority.private_key_pem);
  const Key key = NewKey();
  const Certificate certificate = NewCertificate(common_name, key.get(), valid);
  X509* raw = certificate.get();
  X509_set_issuer_name(raw, X509_get_subject_name(issuer.get()));
  Add(raw, issuer.get(), NID_basic_constraints, "critical,CA:FALSE");
  Add(raw, issuer.get(), NID_key_usage, "critical,digitalSignature");
  Add(raw, issuer.get(), NID_subject_key_identifier, "hash");
  Add(raw, issuer.get(), NID_authority_key_identifier, "keyid:always");
  CheckOpenSsl(X509_sign(raw, issuer_key.get(), EVP_sha256()) > 0, "signing a certificate");
  return {ToPem(certificate), ToPem(key)};
}

std::string MakeRevocationList(const Credentials& authority,
                               const std::vector<std::string>& serials_hex, int number,
                               const Period& valid) {
  const Certificate issuer = ParseCertificate(authority.certificate_pem);
  const Key key = ParseKey(authority.private_key_pem);
  const RevocationList list(X509_CRL_new());
  const Time begin = TimeOf(valid.begin_s);
  const Time end = TimeOf(valid.end_s);
  CheckOpenSsl(list && X509_CRL_set_version(list.get(), kCrlVersion2) == 1 &&
                   X509_CRL_set_issuer_name(list.get(), X509_get_subject_name(issuer.get())) == 1 &&
                   X509_CRL_set1_lastUpdate(list.get(), begin.get()) == 1 &&
                   X509_CRL_set1_nextUpdate(list.get(), end.get()) == 1,
               "making a revocation list");
  for (const std::string& hex : serials_hex) {
    std::unique_ptr<X509_REVOKED, Freed<X509_REVOKED_free>> entry(X509_REVOKED_new());
    const Integer serial = FromHex(hex);
    CheckOpenSsl(entry && X509_REVOKED_set_serialNumber(entry.get(), serial.get()) == 1 &&
                     X509_REVOKED_set_revocationDate(entry.get(), begin.get()) == 1 &&
                     X509_CRL_add0_revoked(list.get(), entry.get()) == 1,
                 "revoking a certificate");
    (void)entry.release();  // the list owns it
  }
  const Integer count(ASN1_INTEGER_new());
  CheckOpenSsl(count && ASN1_INTEGER_set(count.get(), number) == 1 &&
                   X509_CRL_add1_ext_i2d(list.get(), NID_crl_number, count.get(), 0, 0) == 1 &&
                   X509_CRL_sort(list.get()) == 1 &&
                   X509_CRL_sign(list.get(), key.get(), EVP_sha256()) > 0,
               "signing a revocation list");
  const Bio sink = NewSink();
  CheckOpenSsl(PEM_write_bio_X509_CRL(sink.get(), list.get()) == 1, "writing a revocation list");
  return TextOf(sink);
}

CertificateFacts ReadCertificate(const std::string& certificate_pem) {
  const Certificate certificate = ParseCertificate(certificate_pem);
  X509_NAME* subject = X509_get_subject_name(certificate.get());
  const int length = X509_NAME_get_text_by_NID(subject, NID_commonName, nullptr, 0);
  std::string name(length < 0 ? 0 : static_cast<std::size_t>(length), '\0');
  X509_NAME_get_text_by_NID(subject, NID_commonName, name.data(), length + 1);
  return {name,
          ToHex(X509_get0_serialNumber(certificate.get())),
          {ToSeconds(X509_get0_notBefore(certificate.get())),
           ToSeconds(X509_get0_notAfter(certificate.get()))}};
}

std::int64_t RevocationListEnd_s(const std::string& list_pem) {
  return ToSeconds(X509_CRL_get0_nextUpdate(ParseRevocationList(list_pem).get()));
}

std::string Objection(const std::string& certificate_pem, const std::string& authority_pem,
                      const std::string& revocation_list_pem, std::int64_t now_s) {
  const Certificate certificate = ParseCertificate(certificate_pem);
  const Certificate authority = ParseCertificate(authority_pem);
  const Store store(X509_STORE_new());
  CheckOpenSsl(store && X509_STORE_add_cert(store.get(), authority.get()) == 1, "a store");
  RevocationList list;
  if (!revocation_list_pem.empty()) {
    list = ParseRevocationList(revocation_list_pem);
    CheckOpenSsl(X509_STORE_add_crl(store.get(), list.get()) == 1, "a store with revocations");
    X509_STORE_set_flags(store.get(), X509_V_FLAG_CRL_CHECK);
  }
  const StoreContext context(X509_STORE_CTX_new());
  CheckOpenSsl(
      context && X509_STORE_CTX_init(context.get(), store.get(), certificate.get(), nullptr) == 1,
      "verifying a certificate");
  X509_STORE_CTX_set_time(context.get(), 0, now_s);
  if (X509_verify_cert(context.get()) == 1) return {};
  return X509_verify_cert_error_string(X509_STORE_CTX_get_error(context.get()));
}

bool KeyFits(const std::string& certificate_pem, const std::string& private_key_pem) {
  const Certificate certificate = ParseCertificate(certificate_pem);
  const Key key = ParseKey(private_key_pem);
  return EVP_PKEY_eq(X509_get0_pubkey(certificate.get()), key.get()) == 1;
}

bool HaveOneKey(const std::string& a_pem, const std::string& b_pem) {
  const Certificate a = ParseCertificate(a_pem);
  const Certificate b = ParseCertificate(b_pem);
  return EVP_PKEY_eq(X509_get0_pubkey(a.get()), X509_get0_pubkey(b.get())) == 1;
}

}  // namespace palpate::security
