// Starts `azee lsp` for every text of the language and starts it anew when its settings change.
'use strict';

const { commands, window, workspace } = require('vscode');
const { LanguageClient, TransportKind } = require('vscode-languageclient/node');

/** @type {LanguageClient | undefined} */
let client;

/** The server's command line from the settings. */
function serverOptions() {
  const settings = workspace.getConfiguration('azee');
  const [command, ...args] = settings.get('command', ['azee', 'lsp']);
  for (const folder of settings.get('libraries', [])) args.push('--library', folder);
  return { command, args, transport: TransportKind.stdio };
}

async function start() {
  const options = serverOptions();
  client = new LanguageClient('azee', 'AZee', options, {
    documentSelector: [{ language: 'azee' }],
    synchronize: { fileEvents: workspace.createFileSystemWatcher('**/*.{azee,az}') },
  });
  try {
    await client.start();
  } catch (error) {
    window.showErrorMessage(
      `AZee: \`${options.command}\` does not start (${error.message}). Install it with ` +
        "pip install 'azee[lsp]', or name it in the setting azee.command.",
    );
  }
}

async function stop() {
  await client?.stop();
  client = undefined;
}

async function restart() {
  await stop();
  await start();
}

exports.activate = async (context) => {
  context.subscriptions.push(
    commands.registerCommand('azee.restart', restart),
    workspace.onDidChangeConfiguration((change) => {
      if (change.affectsConfiguration('azee')) restart();
    }),
  );
  await start();
};

exports.deactivate = stop;
