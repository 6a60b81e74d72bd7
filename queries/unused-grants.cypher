// name: unused-grants
// kind: table
// description: Which policy lines allow something along which no personal data goes, candidates for a person to remove?
// param mundane: boolean, also lines about channels that a label calls mundane, default false
// param robot: robot, only this robot; all of them if it is empty, default ""
// returns robot: string, name of the robot of the node
// returns enclave: string, enclave that the line is for
// returns node: string, node that the line is for
// returns role: string, what it allows: publish, subscribe, request, reply, call or execute
// returns policy: string, file:line of the policy line
// returns channels: list of string, names of the channels
// returns further: integer, how many further lines allow the same, so that this one alone changes nothing
// order: robot, enclave, node, role, policy
MATCH (a:Element)-[f:FLOWS_TO]->(b:Element)
WHERE f.file IS NOT NULL AND f.role <> 'flow' AND coalesce(f.decision, 'allow') <> 'deny'
WITH f, a, b, CASE WHEN a:Topic|Service|Action THEN b.robot ELSE a.robot END AS robot
WHERE $robot = '' OR robot = $robot
WITH robot, f.file AS file, f.line AS line, f.enclave AS enclave, f.profile AS node, f.role AS role,
     max(size(f.carries)) AS carried, max(size(coalesce(f.further, []))) AS further, collect([a, b]) AS flows
WHERE carried = 0
CALL (flows) {
  UNWIND flows AS ends
  UNWIND ends AS end
  WITH DISTINCT end WHERE end:Topic|Service|Action
  OPTIONAL MATCH (end)-[m:NEVER_HAS]->(:DataCategory)
  WHERE NOT EXISTS { (end)-[o:MAY_HAVE|HAS_ONLY]->(:DataCategory)
                     WHERE coalesce(o.tier, 2) * 10000000 + coalesce(o.specificity, 1000000)
                           > coalesce(m.tier, 2) * 10000000 + coalesce(m.specificity, 1000000)
                           AND NOT (coalesce(o.naming, '') = 'glob' AND coalesce(m.tier, 2) = 0) }
  WITH end.name AS channel, count(m) > 0 AS mundane ORDER BY channel
  RETURN collect(DISTINCT channel) AS channels, min(CASE WHEN mundane THEN 1 ELSE 0 END) = 1 AS never
}
WITH * WHERE $mundane OR NOT never
WITH *, '"line": ' + line + ', "profile": "' + node + '"}' AS here
WHERE NOT EXISTS {
  UNWIND flows AS ends
  UNWIND ends AS end
  MATCH (end:!Topic&!Service&!Action)-[g:FLOWS_TO]-()
  WHERE g.further IS NOT NULL AND size(g.carries) > 0 AND any(other IN g.further WHERE other ENDS WITH here)
}
RETURN robot, enclave, node, role, file + ':' + line AS policy, channels, further
ORDER BY robot, enclave, node, role, policy
