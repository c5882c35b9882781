// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/security/openssl.hpp"

#include <openssl/err.h>
#include <openssl/pem.h>

#include <array>

#include "libs/core/error.hpp"

namespace palpate::security {

namespace {

/// Without it, OpenSSL asks for a password on the terminal.
int NoPassword(char*, int, int, void*) { return 0; }

}  // namespace

void CheckOpenSsl(bool ok, const std::string& what) {
  if (ok) return;
  std::array<char, 256> cause{};
  ERR_error_string_n(ERR_get_error(), cause.data(), cause.size());
  ERR_clear_error();
  throw RunError(what + ": " + cause.data());
}

Bio SourceOf(const std::string& text) {
  Bio bio(BIO_new_mem_buf(text.data(), static_cast<int>(text.size())));
  CheckOpenSsl(bio != nullptr, "reading from memory");
  return bio;
}

Bio NewSink() {
  Bio bio(BIO_new(BIO_s_mem()));
  CheckOpenSsl(bio != nullptr, "writing to memory");
  return bio;
}

std::string TextOf(const Bio& sink) {
  char* data = nullptr;
  const long size = BIO_get_mem_data(sink.get(), &data);
  return std::string(data, static_cast<std::size_t>(size));
}

Certificate ParseCertificate(const std::string& pem) {
  Certificate certificate(PEM_read_bio_X509(SourceOf(pem).get(), nullptr, NoPassword, nullptr));
  ERR_clear_error();
  if (!certificate) throw InputError("is no certificate in PEM format");
  return certificate;
}

RevocationList ParseRevocationList(const std::string& pem) {
  RevocationList list(PEM_read_bio_X509_CRL(SourceOf(pem).get(), nullptr, NoPassword, nullptr));
  ERR_clear_error();
  if (!list) throw InputError("is no revocation list in PEM format");
  return list;
}

Key ParseKey(const std::string& pem) {
  Key key(PEM_read_bio_PrivateKey(SourceOf(pem).get(), nullptr, NoPassword, nullptr));
  ERR_clear_error();
  if (!key) throw InputError("is no private key in PEM format without a password");
  return key;
}

}  // namespace palpate::security
