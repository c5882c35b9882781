// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <openssl/bio.h>
#include <openssl/evp.h>
#include <openssl/pkcs7.h>
#include <openssl/x509.h>
#include <openssl/x509_vfy.h>

#include <memory>
#include <string>

namespace palpate::security {

template <auto Free>
struct Freed {
  template <typename T>
  void operator()(T* object) const {
    Free(object);
  }
};

using Bio = std::unique_ptr<BIO, Freed<BIO_free_all>>;
using Key = std::unique_ptr<EVP_PKEY, Freed<EVP_PKEY_free>>;
using Certificate = std::unique_ptr<X509, Freed<X509_free>>;
using RevocationList = std::unique_ptr<X509_CRL, Freed<X509_CRL_free>>;
using Store = std::unique_ptr<X509_STORE, Freed<X509_STORE_free>>;
using StoreContext = std::unique_ptr<X509_STORE_CTX, Freed<X509_STORE_CTX_free>>;
using Document = std::unique_ptr<PKCS7, Freed<PKCS7_free>>;

/// Throws RunError "WHAT: cause", with OpenSSL's last error, where `ok` is false.
void CheckOpenSsl(bool ok, const std::string& what);

/// A source of `text`, which must outlive it.
Bio SourceOf(const std::string& text);
/// An empty sink, and what was written to one.
Bio NewSink();
std::string TextOf(const Bio& sink);

/// Each throws InputError where the text is none.
Certificate ParseCertificate(const std::string& pem);
RevocationList ParseRevocationList(const std::string& pem);
Key ParseKey(const std::string& pem);

}  // namespace palpate::security
