//! The end: a clean stop tells everybody.

use crate::harness::{Client, Server, Wire, quiet};

#[tokio::test]
async fn a_stop_says_goodbye_and_returns_the_account() {
    let server = Server::start(quiet()).await;
    let mut ann = Client::play(&server, "Ann").await;
    let mut bob = Client::watch(&server, "Bob").await;
    for _ in 0..3 {
        ann.snapshot().await;
    }
    bob.snapshot().await;
    let _silent = Wire::open(&server).await;
    let account = server.stop().await;
    assert_eq!(ann.wire.goodbye().await, "the server ends");
    assert_eq!(bob.wire.goodbye().await, "the server ends");
    assert!(ann.wire.receive().await.is_none());
    assert_eq!(account.clients, 2);
    assert!(account.frames > 0 && account.frame_bytes < 512 * account.frames, "{account}");
}
