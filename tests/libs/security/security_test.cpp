// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#include <gmock/gmock.h>
#include <sys/stat.h>

#include <filesystem>
#include <string>

#include "libs/core/error.hpp"
#include "libs/core/file.hpp"
#include "libs/security/certificates.hpp"
#include "libs/security/material.hpp"
#include "libs/security/permissions.hpp"
#include "libs/security/signed_document.hpp"
#include "tests/support/test_folder.hpp"

namespace palpate::security {
namespace {

using test_support::MessageOf;
using test_support::TestFolder;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr std::int64_t kNow_s = 1'900'000'000;
constexpr std::int64_t kDay_s = 86400;
constexpr Period kYear{kNow_s - kDay_s, kNow_s + 365 * kDay_s};

TEST(Certificates, AnIdentityFollowsFromItsAuthority) {
  const Credentials authority = CreateAuthority("palpate", AuthorityUse::kIdentities, kYear);
  const Credentials identity = IssueIdentity(authority, "capture", kYear);
  EXPECT_EQ(Objection(identity.certificate_pem, authority.certificate_pem, "", kNow_s), "");
  EXPECT_TRUE(KeyFits(identity.certificate_pem, identity.private_key_pem));
  EXPECT_FALSE(KeyFits(identity.certificate_pem, authority.private_key_pem));
  const CertificateFacts facts = ReadCertificate(identity.certificate_pem);
  EXPECT_EQ(facts.common_name, "capture");
  EXPECT_EQ(facts.valid.begin_s, kYear.begin_s);
  EXPECT_EQ(facts.valid.end_s, kYear.end_s);
}

TEST(Certificates, OthersAreObjectedTo) {
  const Credentials authority = CreateAuthority("palpate", AuthorityUse::kIdentities, kYear);
  const Credentials other = CreateAuthority("palpate", AuthorityUse::kIdentities, kYear);
  const Credentials identity = IssueIdentity(authority, "capture", kYear);
  EXPECT_NE(Objection(identity.certificate_pem, other.certificate_pem, "", kNow_s), "");
  EXPECT_EQ(Objection(identity.certificate_pem, authority.certificate_pem, "", kYear.end_s + 1),
            "certificate has expired");
  EXPECT_EQ(Objection(identity.certificate_pem, authority.certificate_pem, "", kYear.begin_s - 1),
            "certificate is not yet valid");
}

TEST(Certificates, TheAuthorityOfDocumentsCannotIssueIdentities) {
  const Credentials documents = CreateAuthority("palpate", AuthorityUse::kDocuments, kYear);
  const Credentials identity = IssueIdentity(documents, "capture", kYear);
  EXPECT_NE(Objection(identity.certificate_pem, documents.certificate_pem, "", kNow_s), "");
}

TEST(Certificates, AnIdentityCannotIssueAnother) {
  const Credentials authority = CreateAuthority("palpate", AuthorityUse::kIdentities, kYear);
  const Credentials identity = IssueIdentity(authority, "capture", kYear);
  const Credentials child = IssueIdentity(identity, "child", kYear);
  EXPECT_NE(Objection(child.certificate_pem, identity.certificate_pem, "", kNow_s), "");
}

TEST(Certificates, ARevocationListNamesTheRevokedAlone) {
  const Credentials authority = CreateAuthority("palpate", AuthorityUse::kIdentities, kYear);
  const Credentials good = IssueIdentity(authority, "good", kYear);
  const Credentials bad = IssueIdentity(authority, "bad", kYear);
  const std::string list =
      MakeRevocationList(authority, {ReadCertificate(bad.certificate_pem).serial_hex}, 1, kYear);
  EXPECT_EQ(Objection(good.certificate_pem, authority.certificate_pem, list, kNow_s), "");
  EXPECT_EQ(Objection(bad.certificate_pem, authority.certificate_pem, list, kNow_s),
            "certificate revoked");
  const std::string none = MakeRevocationList(authority, {}, 2, kYear);
  EXPECT_EQ(Objection(bad.certificate_pem, authority.certificate_pem, none, kNow_s), "");
}

TEST(SignedDocuments, AreReadBackAsTheyWere) {
  const Credentials authority = CreateAuthority("palpate", AuthorityUse::kDocuments, kYear);
  const std::string text = GovernanceXml();
  EXPECT_EQ(VerifiedDocument(SignDocument(text, authority), authority.certificate_pem), text);
}

TEST(SignedDocuments, AChangedLetterIsFound) {
  const Credentials authority = CreateAuthority("palpate", AuthorityUse::kDocuments, kYear);
  std::string document = SignDocument("<topic>rt/forces</topic>\n", authority);
  document.replace(document.find("forces"), 6, "camera");
  EXPECT_THAT(MessageOf([&] { VerifiedDocument(document, authority.certificate_pem); }),
              HasSubstr("was changed after it was signed"));
  EXPECT_THAT(MessageOf([&] { VerifiedDocument("<dds/>", authority.certificate_pem); }),
              HasSubstr("is no signed document"));
}

TEST(SignedDocuments, AnotherSignerIsRefusedEvenIfTheAuthorityIssuedItsCertificate) {
  const Credentials authority = CreateAuthority("palpate", AuthorityUse::kIdentities, kYear);
  const Credentials identity = IssueIdentity(authority, "capture", kYear);
  const std::string document = SignDocument("<dds/>\n", identity);
  EXPECT_THAT(MessageOf([&] { VerifiedDocument(document, authority.certificate_pem); }),
              HasSubstr("signed by another authority"));
}

TEST(Permissions, NameWhatMayBeWrittenAndRead) {
  const AccessRights rights{{"rt/forces", "rt/forces/*/wrench"}, {"rt/robot/joint_states"}};
  const std::string xml = PermissionsXml("force_estimation", rights, kYear);
  EXPECT_EQ(ReadRights(xml), rights);
  EXPECT_EQ(TagText(xml, "subject_name"), "CN=force_estimation");
  EXPECT_EQ(TagText(xml, "default"), "DENY");
}

/// The files of one identity, all good at kNow_s.
class MaterialTest : public testing::Test {
 protected:
  MaterialTest() { Write("capture", kYear); }

  void Write(const std::string& name, const Period& valid) {
    const Credentials own = IssueIdentity(identities_, name, valid);
    serial_ = ReadCertificate(own.certificate_pem).serial_hex;
    Put("identity_ca.cert.pem", identities_.certificate_pem);
    Put("permissions_ca.cert.pem", documents_.certificate_pem);
    Put("cert.pem", own.certificate_pem);
    Put("key.pem", own.private_key_pem);
    Put("crl.pem", MakeRevocationList(identities_, {}, 1, kYear));
    Put("governance.p7s", SignDocument(GovernanceXml(), documents_));
    Put("permissions.p7s",
        SignDocument(PermissionsXml(name, {{"rt/forces"}, {}}, valid), documents_));
    chmod(File("key.pem").c_str(), 0600);
  }
  std::filesystem::path File(const std::string& name) const {
    return folder_ / ("enclaves/capture/" + name);
  }
  void Put(const std::string& name, const std::string& text) {
    folder_.Write("enclaves/capture/" + name, text);
  }
  std::string Refusal(std::int64_t now_s = kNow_s, const std::string& name = "capture") const {
    return MessageOf([&] { LoadMaterial(folder_.path(), name, now_s); });
  }

  TestFolder folder_;
  Credentials identities_ = CreateAuthority("identities", AuthorityUse::kIdentities, kYear);
  Credentials documents_ = CreateAuthority("documents", AuthorityUse::kDocuments, kYear);
  std::string serial_;
};

TEST_F(MaterialTest, GoodFilesAreLoaded) {
  const Material material = LoadMaterial(folder_.path(), "capture", kNow_s);
  EXPECT_EQ(material.private_key, File("key.pem"));
  EXPECT_THAT(CheckMaterial(material, kNow_s), IsEmpty());
}

TEST_F(MaterialTest, AMissingIdentityNamesThoseThatAreThere) {
  EXPECT_THAT(Refusal(kNow_s, "captur"), HasSubstr("no identity 'captur' here (did you mean "
                                                   "'capture'?) (there: capture)"));
  EXPECT_THAT(Refusal(kNow_s, "captur"), HasSubstr("palpate security enroll"));
}

TEST_F(MaterialTest, AMissingFileIsNamed) {
  std::filesystem::remove(File("permissions.p7s"));
  EXPECT_THAT(Refusal(), HasSubstr("permissions.p7s: cannot be read: No such file"));
  Put("permissions.p7s", "");
  EXPECT_THAT(Refusal(), HasSubstr("permissions.p7s: is empty"));
}

TEST_F(MaterialTest, AKeyThatOthersCanReadIsRefused) {
  for (const mode_t mode : {0644u, 0640u, 0604u, 0602u}) {
    chmod(File("key.pem").c_str(), mode);
    EXPECT_THAT(Refusal(), HasSubstr("key.pem: other users may read it (mode 06"));
  }
  EXPECT_THAT(Refusal(), HasSubstr("chmod 600 " + File("key.pem").string()));
  chmod(File("key.pem").c_str(), 0400);
  EXPECT_NO_THROW(LoadMaterial(folder_.path(), "capture", kNow_s));
}

TEST_F(MaterialTest, DatesAreChecked) {
  EXPECT_THAT(Refusal(kYear.end_s + 1), HasSubstr("expired at 2031-"));
  EXPECT_THAT(Refusal(kYear.begin_s - 1), HasSubstr("set the clock of this host"));
  Write("capture", {kNow_s - kDay_s, kNow_s + 10 * kDay_s});
  const auto findings = CheckMaterial(MaterialOf(folder_.path(), "capture"), kNow_s);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].severity, Severity::kWarning);
  EXPECT_THAT(findings[0].ToString(), HasSubstr("cert.pem: expires at 2030-"));
  EXPECT_NO_THROW(LoadMaterial(folder_.path(), "capture", kNow_s));
}

TEST_F(MaterialTest, ARevokedCertificateIsRefused) {
  Put("crl.pem", MakeRevocationList(identities_, {serial_}, 2, kYear));
  EXPECT_THAT(Refusal(), HasSubstr("cert.pem: was revoked"));
  Put("crl.pem", "nothing");
  EXPECT_THAT(Refusal(), HasSubstr("crl.pem: is no revocation list in PEM format"));
}

TEST_F(MaterialTest, ACertificateOfAnotherAuthorityIsRefused) {
  const Credentials other = CreateAuthority("identities", AuthorityUse::kIdentities, kYear);
  std::filesystem::remove(File("crl.pem"));
  Put("identity_ca.cert.pem", other.certificate_pem);
  EXPECT_THAT(Refusal(), HasSubstr("cert.pem: does not follow from"));
}

TEST_F(MaterialTest, AKeyOfAnotherIdentityIsRefused) {
  Put("key.pem", IssueIdentity(identities_, "capture", kYear).private_key_pem);
  chmod(File("key.pem").c_str(), 0600);
  EXPECT_THAT(Refusal(), HasSubstr("key.pem: is not the key of"));
  Put("key.pem", "nothing");
  chmod(File("key.pem").c_str(), 0600);
  EXPECT_THAT(Refusal(), HasSubstr("key.pem: is no private key"));
}

TEST_F(MaterialTest, TamperedAndForeignPermissionsAreRefused) {
  std::string document = ReadFile(File("permissions.p7s"));
  document.replace(document.find("rt/forces"), 9, "rt/*     ");
  Put("permissions.p7s", document);
  EXPECT_THAT(Refusal(), HasSubstr("permissions.p7s: was changed after it was signed"));
  Put("permissions.p7s", SignDocument(PermissionsXml("operator", {}, kYear), documents_));
  EXPECT_THAT(Refusal(), HasSubstr("is for 'CN=operator', not for 'CN=capture'"));
}

TEST_F(MaterialTest, OneAuthorityForBothIsRefused) {
  // As ROS 2's own tool makes them.
  Put("permissions_ca.cert.pem", identities_.certificate_pem);
  EXPECT_THAT(Refusal(), HasSubstr("CVE-2023-24011"));
}

}  // namespace
}  // namespace palpate::security
