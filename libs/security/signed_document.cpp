// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include "libs/security/signed_document.hpp"

#include <openssl/err.h>

#include <algorithm>
#include <memory>

#include "libs/core/error.hpp"
#include "libs/security/openssl.hpp"

namespace palpate::security {

namespace {

struct FreeStack {
  void operator()(STACK_OF(X509) * stack) const { sk_X509_free(stack); }
};

}  // namespace

std::string SignDocument(const std::string& text, const Credentials& authority) {
  constexpr int kFlags = PKCS7_DETACHED | PKCS7_TEXT | PKCS7_STREAM;
  const Certificate certificate = ParseCertificate(authority.certificate_pem);
  const Key key = ParseKey(authority.private_key_pem);
  const Bio source = SourceOf(text);
  const Document document(PKCS7_sign(certificate.get(), key.get(), nullptr, source.get(), kFlags));
  CheckOpenSsl(document != nullptr, "signing a document");
  const Bio sink = NewSink();
  CheckOpenSsl(SMIME_write_PKCS7(sink.get(), document.get(), source.get(), kFlags) == 1,
               "writing a signed document");
  return TextOf(sink);
}

std::string VerifiedDocument(const std::string& document, const std::string& authority_pem) {
  const Certificate authority = ParseCertificate(authority_pem);
  BIO* content = nullptr;
  const Document signature(SMIME_read_PKCS7(SourceOf(document).get(), &content));
  const Bio source(content);
  if (!signature || !source) {
    ERR_clear_error();
    throw InputError("is no signed document (S/MIME)");
  }
  const std::unique_ptr<STACK_OF(X509), FreeStack> signers(sk_X509_new_null());
  sk_X509_push(signers.get(), authority.get());
  const Bio sink = NewSink();
  // The signer must be the authority itself: certificates in the document are not looked at.
  const int verified = PKCS7_verify(signature.get(), signers.get(), nullptr, source.get(),
                                    sink.get(), PKCS7_TEXT | PKCS7_NOVERIFY | PKCS7_NOINTERN);
  ERR_clear_error();
  if (verified != 1) {
    throw InputError("was changed after it was signed, or is signed by another authority");
  }
  std::string text = TextOf(sink);
  text.erase(std::remove(text.begin(), text.end(), '\r'), text.end());
  return text;
}

}  // namespace palpate::security
