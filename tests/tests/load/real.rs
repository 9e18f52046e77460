//! The load against the real server, in this process.

use std::time::Duration;

use starball_server::Config;
use tokio::net::TcpListener;
use tokio::sync::oneshot;

use crate::{classic, load};

#[test]
fn spectators_and_a_bot_at_the_real_server() {
    let runtime = tokio::runtime::Runtime::new().expect("a runtime");
    let (stop, stopped) = oneshot::channel::<()>();
    let (address, served) = runtime.block_on(async {
        let listener = TcpListener::bind("127.0.0.1:0").await.expect("a free port");
        let address = listener.local_addr().expect("bound");
        let shutdown = async {
            let _ = stopped.await;
        };
        let served = tokio::spawn(starball_server::run(listener, Config::new(classic()), shutdown));
        (address, served)
    });
    for (stream, limit) in [("inputs", 200.0), ("state", 6000.0)] {
        let report = load(&format!(
            "--connect {address} --spectators 20 --step-one-in 4 --bots 1 --seconds 3 --stream {stream}"
        ));
        for none in ["missed", "jumps", "digest_mismatches", "lost", "refused"] {
            assert_eq!(report[none], 0, "{none} {report}");
        }
        let bytes = report["bytes_per_spectator_second"].as_f64().expect("a number");
        assert!(bytes > 10.0 && bytes < limit, "{bytes}");
        assert!(report["snapshots"].as_u64() > Some(500), "{report}");
    }
    let hostile =
        load(&format!("--connect {address} --spectators 5 --seconds 3 --stalled 5 --churn 20 --malformed 20"));
    for none in ["missed", "digest_mismatches", "lost", "malformed_not_ended", "not_opened"] {
        assert_eq!(hostile[none], 0, "{none} {hostile}");
    }
    assert!(hostile["churned"].as_u64() > Some(30) && hostile["malformed_sent"].as_u64() > Some(30), "{hostile}");
    drop(stop);
    let ended = runtime.block_on(async { tokio::time::timeout(Duration::from_secs(20), served).await });
    ended.expect("in time").expect("no panic").expect("no error");
}
